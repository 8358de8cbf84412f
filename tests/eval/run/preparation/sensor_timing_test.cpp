#include "eval/run/preparation/sensor_timing.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/support/rolling_shutter.hpp"

namespace fusebench {

using namespace preparation;

namespace {

constexpr SensorTiming kNothingKnown{0.015, 0.015, 0, 0.1, 0.1, 0.1};

/// A hand that swings about all axes.
SE3 swinging_camera(double time_s) {
  return {
      so3_exp({0.10 * std::sin(6 * time_s), 0.15 * std::sin(5 * time_s + 1), 0.06 * std::sin(7 * time_s)}),
      {0.05 * std::sin(4 * time_s), 0.03 * std::cos(5 * time_s), 0.02 * std::sin(3 * time_s)}};
}

CameraMotion motion_at(double time_s) {
  constexpr double kStep_s = 1e-4;
  const SE3 T_world_camera = swinging_camera(time_s);
  const SE3 moved = swinging_camera(time_s - kStep_s).inverse() * swinging_camera(time_s + kStep_s);
  CameraMotion motion{T_world_camera, {}};
  motion.twist << so3_log(moved.rotation) / (2 * kStep_s), moved.translation / (2 * kStep_s);
  return motion;
}

/// 45 frames at 30 Hz of these sensors, with exact motions; the recording gives their delay as told_delay_s.
MovingFrames swing(const SensorTiming& sensors, double told_delay_s = 0) {
  MovingFrames result{testing::small_camera(), {}};
  const testing::TexturedRoom room;
  for (int k = 0; k < 45; ++k) {
    const double time_s = k / 30.0;
    RgbdFrame frame = testing::render_rolling(
        room, result.camera, sensors, [&](double after_s) { return swinging_camera(time_s + after_s); });
    frame.timestamp_ns = static_cast<std::int64_t>(std::llround(1e9 * time_s));
    frame.depth_offset_ns = static_cast<std::int64_t>(std::llround(1e9 * told_delay_s));
    result.frames.push_back({std::move(frame), motion_at(time_s)});
  }
  return result;
}

MeasuredTiming measured(const MovingFrames& frames, const SensorTiming& prior) {
  const Workers workers(2);
  const std::array windows = {frames};
  return measure_timing(windows, prior, 525, workers);
}

TEST(SensorTiming, IsFoundFromTheImagesAlone) {
  for (const SensorTiming& sensors :
       {SensorTiming{0, 0, 0}, SensorTiming{0.015, 0.008, 0.02}, SensorTiming{0.033, 0.026, -0.02}}) {
    const MeasuredTiming timing = measured(swing(sensors), kNothingKnown);
    const Vector3d error_s = timing.posterior.value_s - timing_of(sensors).value_s;
    EXPECT_LT(std::abs(error_s[0]), 1.5e-3) << sensors.color_readout_s;
    EXPECT_LT(std::abs(error_s[1]), 3e-3) << sensors.depth_readout_s;
    EXPECT_LT(std::abs(error_s[2]), 1.5e-3) << sensors.depth_delay_s;
    EXPECT_TRUE((timing.posterior.sigma_s.array() < 6e-3).all()) << timing.posterior.sigma_s.transpose();
  }
}

TEST(SensorTiming, ADelayThatIsToldIsNotCountedTwice) {
  SensorTiming prior = kNothingKnown;
  prior.depth_delay_s = 0.012;
  const MeasuredTiming timing = measured(swing({0.02, 0.02, 0.015}, prior.depth_delay_s), prior);
  EXPECT_NEAR(timing.posterior.value_s[2], 0.015, 1.5e-3);
}

TEST(SensorTiming, WhatIsKnownExactlyIsHeld) {
  SensorTiming prior = kNothingKnown;
  prior.color_readout_s = 0.01;
  prior.color_readout_sigma_s = 0;
  const MeasuredTiming timing = measured(swing({0.03, 0.02, 0}), prior);
  EXPECT_EQ(timing.posterior.value_s[0], 0.01);
  EXPECT_EQ(timing.posterior.sigma_s[0], 0);
  EXPECT_GT(timing.posterior.sigma_s[1], 0);
}

TEST(SensorTiming, WithoutMotionThePriorIsLeft) {
  MovingFrames still = swing({0.03, 0.02, 0});
  for (MovingFrame& moving : still.frames) moving.motion.reset();
  const MeasuredTiming timing = measured(still, kNothingKnown);
  EXPECT_EQ(timing.pairs, 0U);
  EXPECT_EQ(timing.posterior.value_s, timing_of(kNothingKnown).value_s);
  EXPECT_EQ(timing.posterior.sigma_s, timing_of(kNothingKnown).sigma_s);
}

TEST(SensorTiming, DoesNotDependOnTheNumberOfThreads) {
  const std::array windows = {swing({0.02, 0.01, 0.005})};
  const Workers one(1), four(4);
  const MeasuredTiming a = measure_timing(windows, kNothingKnown, 525, one);
  const MeasuredTiming b = measure_timing(windows, kNothingKnown, 525, four);
  EXPECT_EQ(a.posterior.value_s, b.posterior.value_s);
  EXPECT_EQ(a.posterior.sigma_s, b.posterior.sigma_s);
}

}  // namespace
}  // namespace fusebench
