#include "eval/run/batch_estimation/calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

#include "core/config/config.hpp"
#include "eval/run/batch_estimation/smoothing.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/swinging_motion.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace calibration;
using namespace recording;
using namespace batch_estimation;

namespace {

/// A recording of the textured room, in memory.
Recording recording_of(const testing::SimulatedRun& run) {
  Recording recording;
  recording.name = "textured room";
  recording.rig = run.rig;
  recording.imu = run.imu;
  recording.imu_source = ImuSource::recorded;
  recording.calibration = RigCalibration{};
  recording.calibration->imu = ImuCalibration{run.rig.T_imu_camera, run.rig.imu_noise, 0.002};
  const auto frames = std::make_shared<std::vector<RgbdFrame>>(run.frames);
  for (std::size_t k = 0; k < frames->size(); ++k) {
    FrameEntry entry;
    entry.timestamp_ns = entry.capture_ns = (*frames)[k].timestamp_ns;
    recording.frames.push_back(entry);
    recording.ground_truth.push_back({entry.timestamp_ns, run.T_first_camera[k]});
  }
  recording.load_frame = [frames](std::size_t k) -> Result<RgbdFrame> { return (*frames)[k]; };
  return recording;
}

constexpr int kFrames = 36;

TEST(Calibration, RecoversWhatWasDisturbed) {
  const testing::SimulatedRun run = testing::simulate(kFrames);
  Recording recording = recording_of(run);
  recording.rig.T_imu_camera.rotation =
      run.rig.T_imu_camera.rotation * so3_exp(radians(1.0) * Vector3d(0.6, -0.64, 0.48));
  recording.rig.T_imu_camera.translation += Vector3d(-0.006, 0.0064, 0.0048);
  for (ImuSample& sample : recording.imu) sample.timestamp_ns += 10'000'000;
  const Workers workers(1);
  Config config;
  config.photometric.noise_grey = 4;  // what is left without noise: resampling
  const auto found = calibrate(recording, config, {}, workers, {});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_EQ(found->tracked, found->frames);

  // The body turns about one axis: what lies along it must be called undetermined, what lies across be found.
  const Vector3d axis = Vector3d(0.3, 0.9, -0.4).normalized();
  const Vector6d error = pose_minus(found->T_imu_camera, run.rig.T_imu_camera);
  const Vector6d sigma = found->extrinsic_covariance.diagonal().cwiseSqrt();
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(error[i]), 4 * sigma[i]) << "component " << i;
  EXPECT_LT(std::abs(found->time_offset_s - 0.012), 4 * found->time_offset_sigma_s);  // 2 ms were told
  ASSERT_FALSE(found->undetermined.empty());
  double along = 0;
  for (const Undetermined& u : found->undetermined)
    if (u.parameter == "translation") along = std::max(along, std::abs(u.direction.dot(axis)));
  EXPECT_GT(along, 0.9);
}

/// Swings to and fro, so that every constant of the sensors shows: one that only goes on in one direction
/// takes the model along.
testing::SimulatedRun swinging(int count, const SensorTiming& timing) {
  testing::SimulatedRun run;
  run.rig.camera = testing::small_camera();
  run.rig.T_imu_camera = {so3_exp({0.01, -0.02, 0.015}), {0.09, 0.003, 0.002}};
  run.rig.imu_noise = {1e-3, 2e-2, 5e-5, 6e-4};
  const testing::SwingingMotion motion{.swing_rad = 0.4, .sway_m = 0.1};
  const testing::TexturedRoom room;
  const SE3 begin = motion.T_world_imu(0);
  const auto T_room_camera = [&](double t) {
    return SE3{Quaterniond::Identity(), begin.translation} * begin.inverse() * motion.T_world_imu(t) *
           run.rig.T_imu_camera;
  };
  for (int k = 0; k < count; ++k) {
    const double t = k / 30.0;
    run.frames.push_back(testing::render_rolling(room, run.rig.camera, timing,
                                                 [&](double after_s) { return T_room_camera(t + after_s); }));
    run.frames.back().timestamp_ns = 1'000'000'000 + std::llround(1e9 * t);
    run.T_first_camera.push_back(T_room_camera(0).inverse() * T_room_camera(t));
  }
  std::mt19937 random(1);
  run.imu = motion.samples(-0.5, count / 30.0 + 0.5, 200, 1.0, Vector3d::Zero(), Vector3d::Zero(),
                           run.rig.imu_noise, random);
  return run;
}

/// Read-out of colour and delay of depth are not told, and the scales of the IMU are off. That of depth is
/// told: in images of 320 pixels and 60 frames too little of it shows.
TEST(Calibration, FindsTheTimingOfTheImagesAndTheScalesOfTheImu) {
  const SensorTiming truth{.color_readout_s = 0.02, .depth_readout_s = 0.015, .depth_delay_s = 0.006};
  const testing::SimulatedRun run = swinging(60, truth);
  Recording recording = recording_of(run);
  recording.load_frame = [load = recording.load_frame](std::size_t k) {
    auto frame = load(k);
    if (frame) frame->depth_offset_ns = 0;
    return frame;
  };
  recording.rig.timing.color_readout_sigma_s = kUnknownReadoutSigma_s;
  recording.rig.timing.depth_readout_s = truth.depth_readout_s;
  recording.rig.timing.depth_delay_sigma_s = kUnknownDelaySigma_s;
  for (ImuSample& sample : recording.imu) sample.angular_velocity_radps *= 1.02;
  const Workers workers(1);
  Config config;
  config.photometric.noise_grey = 4;
  const auto found = calibrate(recording, config, {}, workers, {});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  const SensorTiming& timing = found->timing;
  EXPECT_LT(timing.color_readout_sigma_s, 0.5 * kUnknownReadoutSigma_s);
  EXPECT_EQ(timing.depth_readout_s, truth.depth_readout_s);
  EXPECT_EQ(timing.depth_readout_sigma_s, 0.0);
  EXPECT_LT(timing.depth_delay_sigma_s, 0.25 * kUnknownDelaySigma_s);
  EXPECT_NEAR(timing.color_readout_s, truth.color_readout_s, 3 * timing.color_readout_sigma_s);
  EXPECT_NEAR(timing.depth_delay_s, truth.depth_delay_s, 3 * timing.depth_delay_sigma_s);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(found->gyroscope_scale.value[i], 1.02, 4 * found->gyroscope_scale.sigma[i]) << "axis " << i;
  const auto document = nlohmann::json::parse(to_json(*found, recording));
  EXPECT_EQ(document["timing"]["depth_delay"]["value_s"], timing.depth_delay_s);
  EXPECT_EQ(document["gyroscope_scale"]["value"][0], found->gyroscope_scale.value[0]);
}

TEST(Calibration, HoldsATimingThatIsToldAsExact) {
  const SensorTiming truth{.color_readout_s = 0.01};
  Recording recording = recording_of(swinging(20, truth));
  recording.rig.timing.color_readout_s = 0.01;
  const auto found = calibrate(recording, Config{}, {.max_rounds = 2}, Workers(1), {});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_EQ(found->timing.color_readout_s, 0.01);
  EXPECT_EQ(found->timing.color_readout_sigma_s, 0.0);
  EXPECT_NE(to_text(*found, recording).find("held: exact by the calibration"), std::string::npos);
}

/// Frames of one angular rate are distorted alike: the read-out of colour does not show.
TEST(Calibration, SaysWhatSteadyMotionDoesNotTell) {
  const testing::SimulatedRun run = testing::simulate(20);
  Recording recording = recording_of(run);
  recording.rig.timing.color_readout_sigma_s = kUnknownReadoutSigma_s;
  const Workers workers(1);
  const auto found = calibrate(recording, Config{}, {.max_rounds = 2}, workers, {});
  ASSERT_TRUE(found.has_value()) << found.error().message;
  EXPECT_GT(found->timing.color_readout_sigma_s, 0.5 * kUnknownReadoutSigma_s);
  EXPECT_NE(to_text(*found, recording).find("not determined by this motion: color_readout"),
            std::string::npos);
}

TEST(Calibration, SaysThatAnImuIsMadeOfTheTruth) {
  Recording recording;
  EXPECT_EQ(to_text(CameraImuCalibration{}, recording).find("synthetic IMU"), std::string::npos);
  recording.imu_source = ImuSource::synthetic;
  EXPECT_NE(to_text(CameraImuCalibration{}, recording).find("synthetic IMU"), std::string::npos);
}

TEST(Calibration, AHopelessFitIsAnErrorWithItsReasons) {
  const Recording recording;
  CameraImuCalibration found;
  found.frames = 60;
  found.tracked = 30;
  found.converged = true;
  EXPECT_TRUE(check_fit(found, recording));
  found.tracked = 18;
  found.converged = false;
  found.rounds.resize(4);
  found.variance_factor = 30747;
  const auto refused = check_fit(found, recording);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::run_failed);
  for (const char* reason : {"still moving after 4 rounds", "18 of 60 frames", "30747 times"})
    EXPECT_NE(refused.error().message.find(reason), std::string::npos) << refused.error().message;
}

TEST(Calibration, WritesAFileThatReadsBack) {
  const testing::SimulatedRun run = testing::simulate(2);
  const Recording recording = recording_of(run);
  CameraImuCalibration found;
  found.frames = 100;
  found.T_imu_camera = {so3_exp({0.1, -0.2, 0.3}), {0.01, 0.02, 0.03}};
  found.time_offset_s = 0.0075;
  found.timing = {0.0331, 0.0302, -0.018, 0.0002, 0.0003, 0.0004};
  found.gyroscope_scale.value = {1.01, 0.99, 1.02};
  found.accelerometer_scale.value = {1, 1, 1};
  const RigCalibration rig = calibrated_rig(recording, found);
  ASSERT_TRUE(rig.imu.has_value());
  EXPECT_EQ(rig.imu->T_imu_camera.translation, found.T_imu_camera.translation);
  EXPECT_EQ(rig.imu->time_offset_s, 0.0075);
  EXPECT_EQ(rig.imu->noise.gyroscope_radps_sqrthz, run.rig.imu_noise.gyroscope_radps_sqrthz);
  EXPECT_EQ(rig.color.timing.depth_delay_s, -0.018);
  EXPECT_EQ(rig.color.timing.depth_delay_sigma_s, 0.0004);
  EXPECT_EQ(rig.imu->gyroscope_scale, Vector3d(1.01, 0.99, 1.02));
  EXPECT_NE(rig.source.find("100 frames of textured room"), std::string::npos);
}

TEST(Calibration, ReadOutsBelowZeroAreWrittenAsZero) {
  const testing::SimulatedRun run = testing::simulate(2);
  Recording recording = recording_of(run);
  recording.calibration->color.pinhole = recording.rig.camera;
  CameraImuCalibration found;
  found.gyroscope_scale.value = found.accelerometer_scale.value = {1, 1, 1};
  found.timing = {-9.3e-5, 1.2, -0.018, 0.0002, 0.0003, 0.0004};
  found.timing_before = found.timing;
  const RigCalibration rig = calibrated_rig(recording, found);
  EXPECT_EQ(rig.color.timing.color_readout_s, 0);
  EXPECT_EQ(rig.color.timing.depth_readout_s, calibration::kMostReadout_s);
  EXPECT_EQ(rig.color.timing.depth_delay_s, -0.018) << "may have either sign";
  const auto readable = calibration::check_readable(calibration::to_toml(rig), "c.toml");
  EXPECT_TRUE(readable) << readable.error().message;
  EXPECT_NE(to_text(found, recording).find("0 in the calibration, since no read-out is below 0 (0.5 sigmas"),
            std::string::npos);
}

TEST(Smoothing, FollowsTheTruthAndIsLabelled) {
  const testing::SimulatedRun run = testing::simulate(kFrames);
  const Recording recording = recording_of(run);
  const Workers workers(1);
  const auto smoothed = smooth(recording, Config{}, workers, {});
  ASSERT_TRUE(smoothed.has_value()) << smoothed.error().message;
  ASSERT_EQ(smoothed->trajectory.size(), run.frames.size());
  double worst_m = 0;
  for (std::size_t k = 0; k < smoothed->trajectory.size(); ++k) {
    const Vector3d error =
        smoothed->trajectory[k].T_world_camera.translation - run.T_first_camera[k].translation;
    worst_m = std::max(worst_m, error.norm());
  }
  EXPECT_LT(worst_m, 0.02);
  EXPECT_TRUE(pseudo_truth_text(*smoothed).starts_with("# pseudo ground truth"));
  const auto document = nlohmann::json::parse(to_json(*smoothed, recording));
  EXPECT_EQ(document["label"], kPseudoGroundTruth);
  EXPECT_TRUE(document["against_ground_truth"].contains("smoothed"));
  EXPECT_TRUE(document["against_ground_truth"].contains("measuring_run"));
  EXPECT_TRUE(smoothing_remarks(*smoothed).empty());
}

TEST(Smoothing, SaysWhatToBewareOf) {
  SmoothedRecording smoothed;
  smoothed.stamps_ns = {1, 2, 3};
  smoothed.tracked = 3;
  smoothed.estimate.rounds = 12;
  std::vector<std::string> remarks = smoothing_remarks(smoothed);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("still moving after 12 rounds"), std::string::npos) << remarks[0];
  smoothed.tracked = 2;
  smoothed.estimate.converged = true;
  remarks = smoothing_remarks(smoothed);
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_NE(remarks[0].find("1 of 3 frames were lost"), std::string::npos) << remarks[0];
}

/// A truth that was smoothed from the recording is nothing to compare with.
TEST(Smoothing, DoesNotCompareWithAPseudoTruth) {
  SmoothedRecording smoothed;
  smoothed.estimate.frames.resize(1);
  Recording recording = recording_of(testing::simulate(2));
  recording.truth_label = kPseudoGroundTruth;
  EXPECT_FALSE(nlohmann::json::parse(to_json(smoothed, recording)).contains("against_ground_truth"));
}

}  // namespace
}  // namespace fusebench
