#include "eval/preparation/sensor_check.hpp"

#include <gtest/gtest.h>

#include "datasets/recording/recording.hpp"
#include "eval/preparation/preparation.hpp"

namespace fusebench {

using namespace preparation;
using inspection::Finding;
using inspection::Severity;

namespace {

recording::Recording recording_at_rest(const Vector3d& bias_radps) {
  recording::Recording recording;
  recording.imu.assign(3, {0, bias_radps, {0, 0, kGravity_mps2}});
  recording.state_truth.resize(1);
  recording.state_truth[0].state.gyroscope_bias_radps = bias_radps;
  return recording;
}

TEST(SensorCheck, ALargeBiasIsTakenOutOfSamplesAndTruth) {
  const Vector3d bias_radps(0.01, -0.02, 0.078);
  recording::Recording recording = recording_at_rest(bias_radps);
  take_out_bias(recording, bias_radps);
  for (const ImuSample& sample : recording.imu) EXPECT_TRUE(sample.angular_velocity_radps.isZero());
  EXPECT_TRUE(recording.state_truth[0].state.gyroscope_bias_radps.isZero());
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_TRUE(recording.notes[0].starts_with(kPreparedNote)) << recording.notes[0];
}

TEST(SensorCheck, ABiasThatTheFilterExpectsIsLeft) {
  const Vector3d bias_radps(0.005, 0, -0.005);
  recording::Recording recording = recording_at_rest(bias_radps);
  take_out_bias(recording, bias_radps);
  EXPECT_EQ(recording.imu[0].angular_velocity_radps, bias_radps);
  EXPECT_TRUE(recording.notes.empty());
}

TEST(SensorCheck, OnlyErrorsOfUnitsGravityAxesAndRecordingInvalidateResults) {
  EXPECT_TRUE(makes_results_invalid({"accelerometer-unit", Severity::error, "", ""}));
  EXPECT_TRUE(makes_results_invalid({"imu-axes-swapped", Severity::error, "", ""}));
  EXPECT_FALSE(makes_results_invalid({"imu-time-offset", Severity::error, "", ""}));
  EXPECT_FALSE(makes_results_invalid({"accelerometer-unit", Severity::warning, "", ""}));
}

}  // namespace
}  // namespace fusebench
