// Motions from which no offset of a clock can be read.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "eval/metrics/reference_clock/time_offset.hpp"
#include "tests/eval/metrics/reference_clock/moving_bodies.hpp"

namespace fusebench {

using namespace reference_clock;
using testing::Motion;
using testing::on_clock;
using testing::random_motion;
using testing::sampled;
using testing::with_errors;

namespace {

SE3 at_rest(double /*time_s*/) { return {so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}}; }

SE3 on_a_line(double time_s) { return {so3_exp({0.1, 0.2, 0.3}), {0.3 * time_s, 0.1 * time_s, 1}}; }

SE3 on_a_helix(double time_s) {
  return {so3_exp({0, 0, 0.5 * time_s}), {std::cos(0.5 * time_s), std::sin(0.5 * time_s), 0.1 * time_s}};
}

SE3 swinging(double time_s) {
  const double angle_rad = 0.3 * std::sin(2 * std::numbers::pi * time_s / 0.8);
  return {so3_exp({0, angle_rad, 0}), {0.2 * angle_rad, 0, 0}};
}

/// Why there is no offset, with errors of both sides.
std::string refusal(const Motion& motion, double reference_error, double estimate_error,
                    double duration_s = 20, double offset_s = 0) {
  const Trajectory reference =
      with_errors(sampled(motion, -1, duration_s + 1, 100), {.white = reference_error}, 1);
  const Trajectory estimate =
      with_errors(on_clock(sampled(motion, 0.005, duration_s, 30), offset_s),
                  {.white = estimate_error, .correlated = estimate_error, .walk = estimate_error}, 2);
  const auto found = fitted_time_offset(reference, estimate);
  if (found) return "found " + fmt::format("{:.3g}", found->offset_s);
  EXPECT_EQ(found.error().code, ErrorCode::data_corrupt);
  return found.error().message;
}

void expect_refused(const std::string& message, const std::string& why) {
  EXPECT_NE(message.find(why), std::string::npos) << message;
}

TEST(UnobservableClock, NoiseOfABodyAtRestIsNoMotion) {
  for (const double reference_error : {0.0, 1e-4, 1e-3, 5e-3}) {
    for (const double estimate_error : {0.0, 1e-4, 1e-3, 5e-3})
      expect_refused(refusal(at_rest, reference_error, estimate_error), "not observable");
  }
}

TEST(UnobservableClock, AStraightLineAtConstantSpeedIsRefused) {
  for (const double error : {0.0, 1e-4, 1e-3, 5e-3}) {
    expect_refused(refusal(on_a_line, error, error), "not observable");
    expect_refused(refusal(on_a_line, 0, error), "not observable");
    expect_refused(refusal(on_a_line, error, 0), "not observable");
  }
}

TEST(UnobservableClock, AHelixAtConstantSpeedIsRefused) {
  for (const double error : {0.0, 1e-4, 1e-3})
    expect_refused(refusal(on_a_helix, error, error), "not observable");
}

TEST(UnobservableClock, TheDecimalsOfAFileAreNoMotion) {
  Trajectory line = sampled(on_a_line, 0, 20, 30);
  for (StampedPose& pose : line) {
    for (int axis = 0; axis < 3; ++axis)
      pose.T_world_camera.translation[axis] = 1e-4 * std::round(1e4 * pose.T_world_camera.translation[axis]);
  }
  EXPECT_FALSE(fitted_time_offset(line, line));
}

TEST(UnobservableClock, AMotionThatRepeatsIsAmbiguous) {
  expect_refused(refusal(swinging, 0, 0), "ambiguous");
  expect_refused(refusal(swinging, 5e-4, 1e-3), "ambiguous");
}

TEST(UnobservableClock, AFewSecondsAreTooLittle) {
  const Motion motion = random_motion(1, 0.5, 0.3);
  expect_refused(refusal(motion, 5e-4, 1e-3, 2.5), "motions of 0.5 s");
  expect_refused(refusal(motion, 5e-4, 1e-3, 0.6), "motions of 0.5 s");
  EXPECT_FALSE(fitted_time_offset({}, {}));
  EXPECT_FALSE(fitted_time_offset(sampled(motion, 0, 10, 100), {}));
  EXPECT_FALSE(fitted_time_offset({}, sampled(motion, 0, 10, 30)));
}

TEST(UnobservableClock, AMovementAmongRestIsAsLongAsItself) {
  const Motion motion = random_motion(1, 0.5, 0.3);
  const Motion mostly_at_rest = [&](double time_s) { return motion(std::max(time_s, 19.2)); };
  expect_refused(refusal(mostly_at_rest, 5e-4, 1e-3), "motions of 0.5 s");
}

TEST(UnobservableClock, OffsetsBeyondHalfASecondAreRefused) {
  const Motion motion = random_motion(2, 0.5, 0.3);
  for (const double offset_s : {0.53, -0.53})
    expect_refused(refusal(motion, 5e-4, 1e-3, 20, offset_s), "beyond the range");
  expect_refused(refusal(motion, 0, 0, 20, 0.45), "found 0.45");
}

TEST(UnobservableClock, HugeNumbersAreRefused) {
  const Motion motion = random_motion(2, 0.5, 0.3);
  for (const double size : {1e9, 1e160, 1e307}) {
    Trajectory reference = sampled(motion, -1, 11, 100);
    Trajectory estimate = sampled(motion, 0, 10, 30);
    for (StampedPose& pose : estimate) pose.T_world_camera.translation *= size;
    EXPECT_FALSE(fitted_time_offset(reference, estimate)) << size;
    EXPECT_FALSE(fitted_time_offset(estimate, reference)) << size;
  }
}

TEST(UnobservableClock, MotionsThatHaveNothingInCommonAreRefused) {
  const auto found = fitted_time_offset(sampled(random_motion(1, 0.5, 0.3), -1, 21, 100),
                                        sampled(random_motion(2, 0.5, 0.3), 0, 20, 30));
  EXPECT_FALSE(found) << found->offset_s << " +- " << found->sigma_s;
}

}  // namespace
}  // namespace fusebench
