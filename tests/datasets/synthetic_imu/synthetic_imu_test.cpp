#include "datasets/synthetic_imu/synthetic_imu.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <random>

#include "datasets/open_recording.hpp"
#include "tests/datasets/recording/formats/tum/tum_folder.hpp"
#include "tests/support/analytic_motion.hpp"

namespace fusebench {

using namespace recording;
using namespace synthetic_imu;
using namespace datasets;

namespace {

using testing::HelixMotion;

const Vector3d kZero = Vector3d::Zero();

HelixMotion helix() {
  HelixMotion motion;
  motion.gravity_world_mps2 = {0, 0, -kGravity_mps2};
  return motion;
}

Trajectory sampled(const HelixMotion& motion, double duration_s, double rate_hz) {
  Trajectory truth;
  const auto count = static_cast<int>(duration_s * rate_hz);
  for (int i = 0; i <= count; ++i) {
    const double t = i / rate_hz;
    truth.push_back({std::llround(1e9 * t), motion.T_world_imu(t)});
  }
  return truth;
}

/// A recording that has only what the synthesis needs.
Recording recording_of(const Trajectory& truth) {
  Recording recording;
  recording.name = "helix";
  recording.ground_truth = truth;
  for (std::int64_t time_ns = 1'000'000'000; time_ns <= 3'000'000'000; time_ns += 33'000'000) {
    recording.frames.push_back({time_ns, time_ns, time_ns, time_ns, {}, {}});
  }
  return recording;
}

TEST(PoseSpline, DerivativesAreThoseOfThePose) {
  std::mt19937_64 engine(3);
  const auto random = [&] { return 1e-3 * static_cast<double>(engine() % 1001) - 0.5; };
  PoseSpline spline(0, 1'000'000'000, 100'000'000);
  for (Vector3d& p : spline.position_world_m) p = {random(), random(), random()};
  for (Quaterniond& q : spline.rotation_world_body) q = so3_exp(Vector3d(random(), random(), random()));
  constexpr std::int64_t kStep_ns = 10'000;
  constexpr double kStep_s = 1e-5;
  for (std::int64_t time_ns = 20'000'000; time_ns < 1'000'000'000; time_ns += 37'000'000) {
    const Kinematics before = spline.evaluate(time_ns - kStep_ns);
    const Kinematics here = spline.evaluate(time_ns);
    const Kinematics after = spline.evaluate(time_ns + kStep_ns);
    const Vector3d rate =
        so3_log(before.T_world_body.rotation.conjugate() * after.T_world_body.rotation) / (2 * kStep_s);
    const Vector3d velocity =
        (after.T_world_body.translation - before.T_world_body.translation) / (2 * kStep_s);
    const Vector3d acceleration = (after.velocity_world_mps - before.velocity_world_mps) / (2 * kStep_s);
    EXPECT_LT((rate - here.angular_velocity_body_radps).norm(), 1e-5) << time_ns;
    EXPECT_LT((velocity - here.velocity_world_mps).norm(), 1e-5) << time_ns;
    EXPECT_LT((acceleration - here.acceleration_world_mps2).norm(), 1e-2) << time_ns;
  }
}

TEST(SyntheticImu, EqualsTheAnalyticMotion) {
  const HelixMotion motion = helix();
  const auto fit = fit_pose_spline(sampled(motion, 4.0, 100), {});
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->converged);
  EXPECT_LT(fit->rotation_residual_rad, 1e-4);
  EXPECT_LT(fit->position_residual_m, 1e-4);
  int compared = 0;
  for (const ImuSample& sample : ideal_imu(fit->spline, 0, 4'000'000'000, 200, motion.gravity_world_mps2)) {
    const double t = 1e-9 * static_cast<double>(sample.timestamp_ns);
    if (t < 0.2 || t > 3.8) continue;  // the smoothest motion has no acceleration at its ends
    ++compared;
    EXPECT_LT((sample.angular_velocity_radps - motion.body_rate_radps).norm(), 1e-4) << t;
    EXPECT_LT((sample.specific_force_mps2 - motion.specific_force_mps2(t)).norm(), 2e-3) << t;
  }
  EXPECT_GE(compared, 720);
}

TEST(SyntheticImu, SmoothingFollowsItsFormula) {
  // The gain of a sine is 1 / (1 + (nu / f)^4): 0.5 at the cutoff.
  for (const double frequency_hz : {3.0, 6.0, 12.0, 18.0}) {
    Trajectory truth;
    for (int i = 0; i <= 400; ++i) {
      const double t = 0.01 * i;
      const double s = std::sin(2 * std::numbers::pi * frequency_hz * t);
      truth.push_back({std::int64_t{10'000'000} * i, {so3_exp({0, 1e-4 * s, 0}), {0, 0, 1e-4 * s}}});
    }
    const auto fit = fit_pose_spline(truth, {});
    ASSERT_TRUE(fit);
    double position = 0;
    double rotation = 0;
    double square = 0;
    for (const StampedPose& pose : truth) {
      const double t = 1e-9 * static_cast<double>(pose.timestamp_ns);
      if (t < 1 || t > 3) continue;
      const double s = std::sin(2 * std::numbers::pi * frequency_hz * t);
      const SE3 fitted = fit->spline.evaluate(pose.timestamp_ns).T_world_body;
      position += 1e4 * fitted.translation.z() * s;
      rotation += 1e4 * so3_log(fitted.rotation).y() * s;
      square += s * s;
    }
    const double gain = 1 / (1 + std::pow(frequency_hz / 12.0, 4));
    EXPECT_NEAR(position / square, gain, 0.05) << frequency_hz;
    EXPECT_NEAR(rotation / square, gain, 0.05) << frequency_hz;
  }
}

TEST(SyntheticImu, OutliersDoNotBendTheFit) {
  const HelixMotion motion = helix();
  Trajectory truth = sampled(motion, 4.0, 100);
  truth[200].T_world_camera.translation.x() += 0.05;
  truth[200].T_world_camera.rotation = truth[200].T_world_camera.rotation * so3_exp({0, 0, 0.2});
  const auto fit = fit_pose_spline(truth, {});
  ASSERT_TRUE(fit);
  const SE3 error = motion.T_world_imu(2.0).inverse() * fit->spline.evaluate(2'000'000'000).T_world_body;
  EXPECT_LT(error.translation.norm(), 0.002);
  EXPECT_LT(so3_log(error.rotation).norm(), 0.01);
}

TEST(SyntheticImu, GapsAreBridgedAndTold) {
  const HelixMotion motion = helix();
  Trajectory truth = sampled(motion, 4.0, 100);
  truth.erase(truth.begin() + 200, truth.begin() + 230);
  Recording recording = recording_of(truth);
  ASSERT_TRUE(add_synthetic_imu(recording));
  ASSERT_EQ(recording.warnings.size(), 1U);
  EXPECT_NE(recording.warnings[0].find("1 gaps"), std::string::npos) << recording.warnings[0];
  EXPECT_NE(recording.warnings[0].find("longest 0.31 s"), std::string::npos) << recording.warnings[0];
  for (const ImuSample& sample : recording.imu) ASSERT_LT(sample.specific_force_mps2.norm(), 20);
}

TEST(SyntheticImu, SameSeedSameBytes) {
  const Trajectory truth = sampled(helix(), 4.0, 100);
  const auto bytes = [&](std::uint64_t seed) {
    Recording recording = recording_of(truth);
    SyntheticImuOptions options;
    options.seed = seed;
    EXPECT_TRUE(add_synthetic_imu(recording, options));
    std::string text;
    for (const ImuSample& s : recording.imu) {
      for (const Vector3d& v : {s.angular_velocity_radps, s.specific_force_mps2}) {
        std::array<char, sizeof(double) * 3> raw{};
        std::memcpy(raw.data(), v.data(), raw.size());
        text.append(raw.data(), raw.size());
      }
    }
    return text;
  };
  const std::string first = bytes(1);
  EXPECT_EQ(first, bytes(1));
  EXPECT_NE(first, bytes(2));
}

TEST(SyntheticImu, NoiseHasTheStatedDensities) {
  const ImuSensor sensor{"test", {2e-3, 3e-2, 1e-3, 2e-2}, 0, 0};
  std::vector<ImuSample> samples(40'000);
  add_imu_noise(samples, sensor, 200, 5);
  // Differences of neighbours: white noise twice, and one step of the walk.
  const auto expect_spread = [&](const auto& value, double density, double walk) {
    double sum = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)
      sum += (value(samples[i]) - value(samples[i - 1])).squaredNorm();
    const double variance = sum / (3.0 * static_cast<double>(samples.size() - 1));
    EXPECT_NEAR(variance / (2 * density * density * 200 + walk * walk / 200), 1, 0.03);
  };
  expect_spread([](const ImuSample& s) { return s.angular_velocity_radps; }, 2e-3, 1e-3);
  expect_spread([](const ImuSample& s) { return s.specific_force_mps2; }, 3e-2, 2e-2);

  // The walk alone: 200 s apart it has moved by density * sqrt(200 s).
  double walked = 0;
  constexpr int kRuns = 60;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    std::vector<ImuSample> walk(1000);
    add_imu_noise(walk, {"test", {0, 0, 1e-3, 0}, 0, 0}, 200, seed);
    EXPECT_EQ(walk.front().angular_velocity_radps, kZero);
    EXPECT_EQ(walk.back().specific_force_mps2, kZero);
    walked += walk.back().angular_velocity_radps.squaredNorm();
  }
  EXPECT_NEAR(walked / (3 * kRuns) / (1e-6 * 999 / 200), 1, 0.4);
}

TEST(SyntheticImu, InitialBiasIsOneForAllSamples) {
  std::vector<ImuSample> samples(3);
  add_imu_noise(samples, {"test", {}, 0.01, 0.1}, 200, 9);
  EXPECT_GT(samples[0].angular_velocity_radps.norm(), 1e-4);
  EXPECT_LT(samples[0].angular_velocity_radps.norm(), 0.06);
  EXPECT_EQ(samples[0].angular_velocity_radps, samples[2].angular_velocity_radps);
  EXPECT_EQ(samples[0].specific_force_mps2, samples[2].specific_force_mps2);
}

TEST(SyntheticImu, SitsAtThePointThatTheTruthIsOf) {
  const Vector3d offset_m(0.03, -0.01, 0.02);
  Recording recording = recording_of(sampled(helix(), 4.0, 100));
  recording.calibration.emplace();
  recording.calibration->color.ground_truth_offset_m = offset_m;
  Recording pseudo = recording;
  pseudo.truth_label = kPseudoGroundTruth;
  ASSERT_TRUE(add_synthetic_imu(recording));
  ASSERT_TRUE(add_synthetic_imu(pseudo));
  EXPECT_EQ(recording.rig.T_imu_camera.translation, offset_m);
  EXPECT_EQ(pseudo.rig.T_imu_camera.translation, kZero) << "a batch estimate is of the camera";
}

TEST(SyntheticImu, FillsTheRecording) {
  Recording recording = recording_of(sampled(helix(), 4.0, 100));
  recording.rig.T_imu_camera.translation = {1, 2, 3};
  SyntheticImuOptions options;
  options.seed = 42;
  options.rate_hz = 250;
  ASSERT_TRUE(add_synthetic_imu(recording, options));
  EXPECT_EQ(recording.imu_source, ImuSource::synthetic);
  EXPECT_EQ(to_string(recording.imu_source), "synthetic IMU");
  EXPECT_EQ(recording.rig.T_imu_camera.translation, kZero);
  ASSERT_EQ(recording.imu.size(), 1001U);
  EXPECT_LE(recording.imu.front().timestamp_ns, recording.frames.front().timestamp_ns);
  EXPECT_GE(recording.imu.back().timestamp_ns, recording.frames.back().timestamp_ns);
  for (const char* part : {"ZR300", "seed 42", "250 Hz", "every 20 ms", "deg", "mm"}) {
    EXPECT_NE(recording.imu_note.find(part), std::string::npos) << part << " in: " << recording.imu_note;
  }
  EXPECT_GE(recording.rig.imu_noise.gyroscope_radps_sqrthz, 1.10e-3);
  EXPECT_EQ(recording.rig.imu_noise.gyroscope_bias_radps2_sqrthz, 5.0e-5);
}

TEST(SyntheticImu, ReportedNoiseGrowsWithTheTruthsJitter) {
  std::mt19937_64 engine(11);
  const auto jitter = [&] { return 2e-3 * (1e-3 * static_cast<double>(engine() % 1001) - 0.5); };
  Trajectory truth = sampled(helix(), 4.0, 100);
  for (StampedPose& pose : truth) {
    pose.T_world_camera.rotation = pose.T_world_camera.rotation * so3_exp({jitter(), jitter(), jitter()});
  }
  const SplineFitOptions options;
  const auto fit = fit_pose_spline(truth, options);
  ASSERT_TRUE(fit);
  // Uniform within +-1 mrad: 0.58 mrad rms, most of which the fit takes away.
  EXPECT_NEAR(fit->rotation_residual_rad, 0.5e-3, 0.07e-3);
  // Independent check of the density: how far the fit's turn is really off over the horizon of one second.
  double square = 0;
  int count = 0;
  const HelixMotion motion = helix();
  for (std::int64_t time_ns = 500'000'000; time_ns < 2'500'000'000; time_ns += 33'333'333) {
    const auto error = [&](std::int64_t at_ns) {
      const Quaterniond fitted = fit->spline.evaluate(at_ns).T_world_body.rotation;
      return so3_log(motion.T_world_imu(1e-9 * static_cast<double>(at_ns)).rotation.conjugate() * fitted);
    };
    square += (error(time_ns + 1'000'000'000) - error(time_ns)).squaredNorm();
    count += 3;
  }
  const double real_density = std::sqrt(square / count);
  const double stated_density = truth_noise(*fit, {}).gyroscope_radps_sqrthz;
  EXPECT_GT(stated_density, real_density);
  EXPECT_LT(stated_density, 4 * real_density);
}

TEST(SyntheticImu, RefusesWhatItCannotDo) {
  const Trajectory truth = sampled(helix(), 4.0, 100);
  Recording none = recording_of({});
  EXPECT_EQ(add_synthetic_imu(none).error().code, ErrorCode::data_missing);

  Recording partly = recording_of({truth.begin() + 150, truth.end()});
  const auto uncovered = add_synthetic_imu(partly);
  ASSERT_FALSE(uncovered);
  EXPECT_EQ(uncovered.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(uncovered.error().message.find("covers 45 of 61 frames"), std::string::npos)
      << uncovered.error().message;
  EXPECT_NE(uncovered.error().hint.find("--frames 16:61"), std::string::npos) << uncovered.error().hint;
  EXPECT_EQ(partly.imu_source, ImuSource::none);

  Recording recording = recording_of(truth);
  SyntheticImuOptions options;
  options.rate_hz = 0;
  EXPECT_EQ(add_synthetic_imu(recording, options).error().code, ErrorCode::configuration);
  options.rate_hz = 200;
  options.fit.cutoff_hz = -1;
  const auto cutoff = add_synthetic_imu(recording, options);
  ASSERT_FALSE(cutoff);
  EXPECT_EQ(cutoff.error().code, ErrorCode::configuration);
  EXPECT_NE(cutoff.error().message.find("cutoff_hz = -1 (allowed 0.1 .. 1000)"), std::string::npos);

  EXPECT_EQ(fit_pose_spline({truth.begin(), truth.begin() + 3}, {}).error().code, ErrorCode::data_corrupt);
}

/// Within 2 % of gravity on average, although the camera is shaken, and close to what the Kinect's own
/// accelerometer felt at the same time (its axes are about diag(-1, -1, 1) of the camera's).
TEST(SyntheticImu, AgreesWithTheKinectsAccelerometer) {
  auto recording = open_recording(testing::golden_tum_folder());
  ASSERT_TRUE(recording);
  const auto fit = fit_pose_spline(recording->ground_truth, {});
  ASSERT_TRUE(fit);
  Vector3d felt = Vector3d::Zero();
  Vector3d synthesised = Vector3d::Zero();
  int count = 0;
  for (const AccelerometerSample& sample : recording->accelerometer) {
    if (sample.timestamp_ns < recording->frames.front().timestamp_ns ||
        sample.timestamp_ns > recording->frames.back().timestamp_ns) {
      continue;
    }
    const Kinematics k = fit->spline.evaluate(sample.timestamp_ns);
    synthesised +=
        k.T_world_body.rotation.conjugate() * (k.acceleration_world_mps2 - Vector3d(0, 0, -kGravity_mps2));
    felt += Vector3d(-1, -1, 1).cwiseProduct(sample.specific_force_mps2);
    ++count;
  }
  ASSERT_GT(count, 50);
  felt /= count;
  synthesised /= count;
  EXPECT_NEAR(synthesised.norm(), kGravity_mps2, 0.5);
  EXPECT_LT((felt - synthesised).norm(), 1.5)
      << "felt " << felt.transpose() << ", made " << synthesised.transpose();
}

/// Correlation of two series of vectors, axis by axis.
Vector3d correlation(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  Vector3d mean_a = Vector3d::Zero();
  Vector3d mean_b = Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / static_cast<double>(a.size());
    mean_b += b[i] / static_cast<double>(b.size());
  }
  Vector3d ab = Vector3d::Zero();
  Vector3d aa = Vector3d::Zero();
  Vector3d bb = Vector3d::Zero();
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vector3d da = a[i] - mean_a;
    const Vector3d db = b[i] - mean_b;
    ab += da.cwiseProduct(db);
    aa += da.cwiseProduct(da);
    bb += db.cwiseProduct(db);
  }
  return ab.cwiseQuotient(aa.cwiseProduct(bb).cwiseSqrt());
}

TEST(SyntheticImu, WholeRecordingFollowsTheKinectsAccelerometer) {
  const char* data = std::getenv("FUSEBENCH_DATA");
  if (data == nullptr) GTEST_SKIP() << "FUSEBENCH_DATA does not name a folder with recordings";
  const auto folder = std::filesystem::path(data) / "rgbd_dataset_freiburg1_rpy_first240";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  const auto recording = open_recording(folder);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->frames.size(), 240U);
  EXPECT_TRUE(recording->warnings.empty());
  const auto fit = fit_pose_spline(recording->ground_truth, {});
  ASSERT_TRUE(fit && fit->converged);
  EXPECT_NEAR(fit->rotation_residual_rad * 180 / std::numbers::pi, 0.055, 0.01);
  EXPECT_NEAR(1e3 * fit->position_residual_m, 0.10, 0.02);

  // The accelerometer's stamps are about 20 ms early; means over 0.1 s compare motion rather than noise.
  std::vector<Vector3d> felt;
  std::vector<Vector3d> made;
  constexpr std::size_t kTogether = 50;
  for (std::size_t i = 250; i + kTogether < recording->accelerometer.size() - 250; i += kTogether) {
    felt.emplace_back(Vector3d::Zero());
    made.emplace_back(Vector3d::Zero());
    for (std::size_t j = i; j < i + kTogether; ++j) {
      const AccelerometerSample& sample = recording->accelerometer[j];
      const Kinematics k = fit->spline.evaluate(sample.timestamp_ns + 20'000'000);
      felt.back() += Vector3d(-1, -1, 1).cwiseProduct(sample.specific_force_mps2) / kTogether;
      made.back() += k.T_world_body.rotation.conjugate() *
                     (k.acceleration_world_mps2 - Vector3d(0, 0, -kGravity_mps2)) / kTogether;
    }
  }
  const Vector3d agreement = correlation(felt, made);
  EXPECT_GT(agreement.minCoeff(), 0.95) << agreement.transpose();
}

}  // namespace
}  // namespace fusebench
