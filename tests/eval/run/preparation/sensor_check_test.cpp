#include "eval/run/preparation/sensor_check.hpp"

#include <gtest/gtest.h>

#include "datasets/recording/recording.hpp"
#include "eval/run/preparation/preparation.hpp"

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

TEST(SensorCheck, ALargeTimeOffsetMovesStampsAndTruthAndLeavesNoFrameWithoutSamples) {
  recording::Recording recording = recording_at_rest(Vector3d::Zero());
  for (std::size_t i = 0; i < recording.imu.size(); ++i)
    recording.imu[i] = {static_cast<std::int64_t>(i) * 100'000'000, {static_cast<double>(i), 0, 0}, {}};
  recording.state_truth[0].state.imu_time_offset_s = 0.07;
  take_out_time_offset(recording, 0.06);
  ASSERT_EQ(recording.imu.size(), 4U);
  EXPECT_EQ(recording.imu[0].timestamp_ns, -60'000'000);
  EXPECT_EQ(recording.imu[2].timestamp_ns, 140'000'000);
  EXPECT_EQ(recording.imu[3].timestamp_ns, 200'000'000);
  EXPECT_EQ(recording.imu[3].angular_velocity_radps, recording.imu[2].angular_velocity_radps);
  EXPECT_NEAR(recording.state_truth[0].state.imu_time_offset_s, 0.01, 1e-12);
  ASSERT_EQ(recording.notes.size(), 1U);
  EXPECT_TRUE(recording.notes[0].starts_with(kPreparedNote)) << recording.notes[0];
}

TEST(SensorCheck, ATimeOffsetThatTheFilterExpectsIsLeft) {
  recording::Recording recording = recording_at_rest(Vector3d::Zero());
  take_out_time_offset(recording, -0.009);
  EXPECT_EQ(recording.imu[0].timestamp_ns, 0);
  EXPECT_TRUE(recording.notes.empty());
}

TEST(SensorCheck, OnlyErrorsOfUnitsGravityAxesAndRecordingInvalidateResults) {
  EXPECT_TRUE(makes_results_invalid({"accelerometer-unit", Severity::error, "", ""}));
  EXPECT_TRUE(makes_results_invalid({"imu-axes-swapped", Severity::error, "", ""}));
  EXPECT_FALSE(makes_results_invalid({"imu-time-offset", Severity::error, "", ""}));
  EXPECT_FALSE(makes_results_invalid({"accelerometer-unit", Severity::warning, "", ""}));
}

TEST(SensorCheck, ARefusalHasAllReasonsAndRemedies) {
  SensorCheck check;
  check.findings = {
      {"accelerometer-unit", Severity::error, "the values are in g", "multiply them by 9.80665"},
      {"imu-time-offset", Severity::error, "late", "add 0.02"},
      {"accelerometer-sign", Severity::error, "its sign is wrong", "negate the values"}};
  const auto refused = refusal(check, "desk");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->code, ErrorCode::data_corrupt);
  EXPECT_EQ(refused->message, "the IMU of 'desk': the values are in g; its sign is wrong");
  EXPECT_EQ(refused->hint, "multiply them by 9.80665; negate the values");
  check.findings = {{"imu-time-offset", Severity::error, "late", "add 0.02"}};
  EXPECT_FALSE(refusal(check, "desk"));
}

TEST(SensorCheck, AxesOfOneSensorInvalidateResults) {
  EXPECT_TRUE(makes_results_invalid({"gyroscope-axes", Severity::error, "", ""}));
  EXPECT_TRUE(makes_results_invalid({"accelerometer-axes", Severity::error, "", ""}));
}

}  // namespace
}  // namespace fusebench
