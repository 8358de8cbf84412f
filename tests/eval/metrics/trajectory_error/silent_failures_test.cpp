#include "eval/metrics/trajectory_error/silent_failures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/geometry.hpp"

namespace fusebench {

using namespace trajectory_error;

namespace {

constexpr std::int64_t kStep_ns = 100'000'000;

/// A camera that moves and turns for `count` frames at 10 Hz.
Trajectory true_motion(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double t = 0.1 * i;
    trajectory.push_back({i * kStep_ns, {so3_exp({0.2 * t, 0.5 * t, 0}), {0.3 * t, 0.1 * std::sin(t), 0}}});
  }
  return trajectory;
}

TEST(SilentFailures, ThereAreNoneInATrueTrajectoryWhateverItsWorld) {
  const Trajectory truth = true_motion(60);
  Trajectory estimate = truth;
  const SE3 T_other_world(so3_exp({1, -0.5, 2}), {10, 20, -3});
  for (StampedPose& pose : estimate) pose.T_world_camera = T_other_world * pose.T_world_camera;
  const auto result = silent_failures(truth, estimate);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(result->judged, 59U);
  EXPECT_EQ(result->silent, 0U);
  EXPECT_FALSE(result->first_ns);
  EXPECT_LT(result->worst_translation_m, 1e-9);
}

TEST(SilentFailures, AJumpIsOneForAsLongAsTheMotionSpansIt) {
  const Trajectory truth = true_motion(60);
  Trajectory estimate = truth;
  for (std::size_t i = 30; i < estimate.size(); ++i) estimate[i].T_world_camera.translation.x() += 0.06;
  const auto result = silent_failures(truth, estimate);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->silent, 10U);  // frames 30 to 39 are compared with frames 20 to 29
  EXPECT_EQ(result->first_ns, 30 * kStep_ns);
  EXPECT_NEAR(result->worst_translation_m, 0.06, 1e-9);
  EXPECT_EQ(silent_failures(truth, estimate, {1.0, 0.061, 0.1})->silent, 0U);
  EXPECT_EQ(silent_failures(truth, estimate, {0.5, 0.05, 0.1})->silent, 5U);
}

TEST(SilentFailures, ATurnCountsByItself) {
  const Trajectory truth = true_motion(60);
  Trajectory estimate = truth;
  for (std::size_t i = 45; i < estimate.size(); ++i)
    estimate[i].T_world_camera.rotation = estimate[i].T_world_camera.rotation * so3_exp({0, 0, radians(3.5)});
  const auto result = silent_failures(truth, estimate);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->silent, 10U);
  EXPECT_NEAR(degrees(result->worst_rotation_rad), 3.5, 1e-6);
}

TEST(SilentFailures, AFrameAfterAGapIsJudgedByTheWholeGap) {
  const Trajectory truth = true_motion(60);
  Trajectory estimate = truth;
  estimate.erase(estimate.begin() + 20, estimate.begin() + 40);
  EXPECT_EQ(silent_failures(truth, estimate)->silent, 0U);
  for (std::size_t i = 20; i < estimate.size(); ++i) estimate[i].T_world_camera.translation.z() += 0.1;
  const auto result = silent_failures(truth, estimate);
  EXPECT_EQ(result->silent, 10U);
  EXPECT_EQ(result->first_ns, 40 * kStep_ns);
}

TEST(SilentFailures, AJumpInTheFirstSecondIsSeen) {
  const Trajectory truth = true_motion(20);
  Trajectory estimate = truth;
  for (std::size_t i = 3; i < estimate.size(); ++i) estimate[i].T_world_camera.translation.x() += 0.06;
  EXPECT_EQ(silent_failures(truth, estimate)->first_ns, 3 * kStep_ns);
}

TEST(SilentFailures, APoseThatIsNoNumberIsOne) {
  const Trajectory truth = true_motion(20);
  Trajectory estimate = truth;
  estimate[15].T_world_camera.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(silent_failures(truth, estimate)->silent, 1U);
}

TEST(SilentFailures, WhatHasNoTruthIsNotJudged) {
  const Trajectory truth = true_motion(20);
  Trajectory estimate = true_motion(60);
  EXPECT_EQ(silent_failures(truth, estimate)->judged, 19U);
  for (StampedPose& pose : estimate) pose.timestamp_ns += 100 * kStep_ns;
  EXPECT_FALSE(silent_failures(truth, estimate));
}

}  // namespace
}  // namespace fusebench
