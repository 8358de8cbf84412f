#include "eval/report/speed_failures/failures_by_speed.hpp"

#include <gtest/gtest.h>

#include "core/base/geometry.hpp"

namespace fusebench {

using namespace speed_failures;

namespace {

constexpr std::int64_t kFrame_ns = 33'000'000;

/// Turns by this speed for two seconds, then by three times as much for one.
Trajectory turning(double degps) {
  Trajectory truth;
  double angle_rad = 0;
  for (int i = 0; i < 92; ++i) {
    truth.push_back({i * kFrame_ns, {so3_exp({0, angle_rad, 0}), Vector3d(0.001 * i, 0, 0)}});
    angle_rad += radians(i < 61 ? degps : 3 * degps) * 1e-9 * kFrame_ns;
  }
  return truth;
}

std::vector<std::int64_t> stamps_of(const Trajectory& trajectory) {
  std::vector<std::int64_t> stamps;
  for (const StampedPose& pose : trajectory) stamps.push_back(pose.timestamp_ns);
  return stamps;
}

TEST(FailuresBySpeed, WhatIsRightHasNone) {
  const Trajectory truth = turning(60);
  const auto bins = failures_by_speed(truth, stamps_of(truth), truth);
  ASSERT_EQ(bins.size(), 4U);
  EXPECT_EQ(bins[0].frames + bins[2].frames, bins[2].frames) << "nothing is slower than 60 deg/s";
  EXPECT_GT(bins[1].frames, 50U);
  EXPECT_GT(bins[3].frames, 25U);
  for (const SpeedBin& bin : bins) EXPECT_EQ(bin.lost + bin.silent, 0U);
}

TEST(FailuresBySpeed, LostAndSilentFramesAreInTheBinsOfTheirMotion) {
  const Trajectory truth = turning(60);
  Trajectory estimate = truth;
  for (std::size_t i = 70; i < estimate.size(); ++i) estimate[i].T_world_camera.translation.y() += 0.06;
  estimate.erase(estimate.begin() + 80, estimate.begin() + 85);
  const auto bins = failures_by_speed(truth, stamps_of(truth), estimate);
  ASSERT_EQ(bins.size(), 4U);
  EXPECT_EQ(bins[1].lost + bins[1].silent, 0U);
  EXPECT_EQ(bins[3].lost, 5U);
  EXPECT_EQ(bins[3].silent, 22U - 5U) << "within a second after the step of 6 cm";
}

TEST(FailuresBySpeed, NothingIsSaidWithoutTruth) {
  const Trajectory estimate = turning(60);
  EXPECT_TRUE(failures_by_speed({}, stamps_of(estimate), estimate).empty());
}

}  // namespace
}  // namespace fusebench
