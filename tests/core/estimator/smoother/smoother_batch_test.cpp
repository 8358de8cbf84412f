#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

#include "core/estimator/smoother/batch_estimate.hpp"
#include "core/estimator/smoother/residuals.hpp"
#include "tests/support/analytic_motion.hpp"
#include "tests/support/large_matrices.hpp"
#include "tests/support/swinging_motion.hpp"

namespace fusebench {

using namespace simd;
using namespace filter;
using namespace prediction;
using namespace measurement;
using namespace smoother;

namespace {

using testing::SwingingMotion;

constexpr double kFrameRateHz = 30;
const ImuNoise kNoise{1e-3, 2e-2, 5e-5, 6e-4};

/// Ground truth of a synthetic recording and its measurements.
struct MadeUp {
  SwingingMotion motion;
  SE3 T_imu_camera{so3_exp({0.02, -0.03, 0.01}), {0.09, 0.003, -0.02}};
  double time_offset_s = 0;
  Vector3d gyroscope_bias{0.003, -0.002, 0.004};
  Vector3d accelerometer_bias{0.04, -0.03, 0.05};
  double rotation_sigma_rad = 3e-4;  ///< of the motion between two images
  double translation_sigma_m = 5e-4;
  double claimed_sigmas = 1;  ///< claimed standard deviation divided by the true one
  double correlation = 0;     ///< of the errors of one motion and the next
  std::vector<ImuSample> imu;
};

MadeUp made_up(std::mt19937& random, const ImuNoise& noise, int frames, MadeUp data = {}) {
  data.imu = data.motion.samples(-0.5, frames / kFrameRateHz + 0.5, 200, data.time_offset_s,
                                 data.gyroscope_bias, data.accelerometer_bias, noise, random);
  return data;
}

/// World is the first pose as the input's extrinsic puts it, which leaves its orientation arbitrary.
BatchInput input_of(const MadeUp& data, int frames, std::mt19937& random, double noise) {
  BatchInput input;
  input.imu = data.imu;
  input.imu_noise = kNoise;
  input.T_imu_camera = data.T_imu_camera;
  input.time_offset_s = data.time_offset_s;
  std::normal_distribution<double> normal;
  Vector6d sigma;
  sigma << Vector3d::Constant(data.rotation_sigma_rad), Vector3d::Constant(data.translation_sigma_m);
  Vector6d error = Vector6d::Zero();
  const double kept = data.correlation;
  for (int k = 0; k < frames; ++k) {
    const double t = k / kFrameRateHz;
    input.instants_ns.push_back(std::llround(1e9 * t));
    FilterState state;
    state.T_world_imu = data.motion.T_world_imu(t);
    state.velocity_world_mps = data.motion.velocity_world_mps(t);
    state.gravity_direction_world = data.motion.gravity_world_mps2.normalized();
    input.initial.push_back(state);
    for (int i = 0; i < 6; ++i)
      error[i] = kept * error[i] + std::sqrt(1 - kept * kept) * sigma[i] * normal(random);
    if (k == 0) continue;
    RelativeCameraMotion motion;
    motion.reference = static_cast<std::size_t>(k - 1);
    motion.frame = static_cast<std::size_t>(k);
    const SE3 T = (data.motion.T_world_imu(t - 1 / kFrameRateHz) * data.T_imu_camera).inverse() *
                  (data.motion.T_world_imu(t) * data.T_imu_camera);
    motion.T_reference_camera = {T.rotation * so3_exp(noise * error.head<3>()),
                                 T.translation + noise * error.tail<3>()};
    motion.covariance = (data.claimed_sigmas * sigma).cwiseAbs2().asDiagonal();
    input.visual.push_back(motion);
  }
  return input;
}

BatchOptions calibrating() {
  BatchOptions options;
  options.rotation_prior_rad = 0.1;
  options.translation_prior_m = 0.1;
  options.time_offset_prior_s = 0.05;
  return options;
}

/// Errors of a calibration with a ruler.
void disturb(BatchInput& input) {
  input.T_imu_camera.rotation =
      input.T_imu_camera.rotation * so3_exp(radians(1.0) * Vector3d(0.6, -0.64, 0.48));
  input.T_imu_camera.translation += 0.01 * Vector3d(-0.6, 0.64, 0.48);
  input.time_offset_s += 0.01;
}

struct CommonError {
  Eigen::Matrix<double, 7, 1> value;
  Eigen::MatrixXd covariance;
  [[nodiscard]] double normalised() const { return testing::normalised(value, covariance); }
};

CommonError calibration_error(const BatchEstimate& estimate, const MadeUp& truth) {
  CommonError error;
  error.value << pose_minus(estimate.T_imu_camera, truth.T_imu_camera),
      estimate.time_offset_s - truth.time_offset_s;
  error.covariance = estimate.common_covariance.block<7, 7>(kCommonRotation, kCommonRotation);
  return error;
}

TEST(InertialResidual, VanishesOnTheHelixAndFollowsBiasAndOffset) {
  const testing::HelixMotion helix;
  const Vector3d gyroscope_bias(0.01, -0.02, 0.015);
  const Vector3d accelerometer_bias(0.1, 0.2, -0.15);
  const double offset_s = 0.004;
  auto samples = helix.samples(0, 2, 1000, gyroscope_bias, accelerometer_bias);
  for (ImuSample& sample : samples) sample.timestamp_ns += std::llround(1e9 * offset_s);
  const std::int64_t begin_ns = 500'000'000;
  const std::int64_t end_ns = 533'333'333;
  // Integrated with neither the biases nor the offset: the first order has to bring them in.
  const auto imu = preintegrate(samples, begin_ns, end_ns, {}, kNoise);
  ASSERT_TRUE(imu.has_value());
  const InertialResidual residual{*imu, {}, 0, Matrix9d::Identity()};
  const double begin_s = 1e-9 * begin_ns;
  const double end_s = 1e-9 * end_ns;
  const SE3 begin = helix.T_world_imu(begin_s);
  const SE3 end = helix.T_world_imu(end_s);
  const Vector3d velocity_begin = helix.velocity_world_mps(begin_s);
  const Vector3d velocity_end = helix.velocity_world_mps(end_s);
  const Vector3d down = helix.gravity_world_mps2.normalized();
  Vector6d bias;
  bias << gyroscope_bias, accelerometer_bias;
  const Vector3d none = Vector3d::Zero();
  const auto evaluate = [&](const Vector6d& at_bias, double at_offset_s) {
    Eigen::Matrix<double, 9, 1> r;
    residual(begin.rotation.coeffs().data(), begin.translation.data(), velocity_begin.data(), at_bias.data(),
             end.rotation.coeffs().data(), end.translation.data(), velocity_end.data(), down.data(),
             &at_offset_s, none.data(), none.data(), r.data());
    return r;
  };
  const auto r = evaluate(bias, offset_s);
  EXPECT_LT(r.head<3>().norm(), 2e-6);
  EXPECT_LT(r.segment<3>(3).norm(), 1e-5);
  EXPECT_LT(r.tail<3>().norm(), 1e-6);
  EXPECT_GT(evaluate(bias, 0).segment<3>(3).norm(), 20 * r.segment<3>(3).norm());
  EXPECT_GT(evaluate(Vector6d::Zero(), offset_s).head<3>().norm(), 100 * r.head<3>().norm());
}

TEST(VisualResidual, IsTheWhitenedErrorOfTheCameraWhereverTheImuIs) {
  const SE3 T_imu_camera{so3_exp({0.3, -0.2, 0.5}), {0.1, 0.05, -0.2}};
  const SE3 a{so3_exp({0.1, 0.2, 0.3}), {1, 2, 3}};
  const SE3 b{so3_exp({0.4, -0.1, 0.2}), {1.2, 1.9, 3.3}};
  const SE3 T = (a * T_imu_camera).inverse() * (b * T_imu_camera);
  const Vector3d turn(0.01, -0.02, 0.03);
  const Vector3d shift(0.1, 0.2, -0.1);
  RelativeCameraMotion motion;
  motion.T_reference_camera = {T.rotation * so3_exp(-turn), T.translation - shift};
  motion.timing_s = {0.01, 0.02, 0.03};
  motion.by_timing.setRandom();
  const VisualResidual residual{motion, 2 * Matrix6d::Identity()};
  const auto evaluate = [&](const Vector3d& timing_s) {
    Vector6d r;
    residual(a.rotation.coeffs().data(), a.translation.data(), b.rotation.coeffs().data(),
             b.translation.data(), T_imu_camera.rotation.coeffs().data(), T_imu_camera.translation.data(),
             &timing_s[0], &timing_s[1], &timing_s[2], r.data());
    return r;
  };
  const Vector6d r = evaluate(motion.timing_s);
  EXPECT_LT((r.head<3>() - 2 * turn).norm(), 1e-12);
  EXPECT_LT((r.tail<3>() - 2 * shift).norm(), 1e-12);
  const Vector3d later_s(0.001, -0.002, 0.003);
  EXPECT_LT((evaluate(motion.timing_s + later_s) - r + 2 * motion.by_timing * later_s).norm(), 1e-12);
}

TEST(BatchEstimate, FindsTheCalibrationThatExactDataWereMadeWith) {
  std::mt19937 random(1);
  MadeUp data;
  data.time_offset_s = 0.007;
  data = made_up(random, ImuNoise{}, 90, data);
  BatchInput input = input_of(data, 90, random, 0.0);
  disturb(input);
  const auto estimate = estimate_batch(input, calibrating());
  ASSERT_TRUE(estimate.has_value());
  EXPECT_TRUE(estimate->converged);
  const CommonError error = calibration_error(*estimate, data);
  EXPECT_LT(error.value.head<3>().norm(), radians(0.005));
  EXPECT_LT(error.value.segment<3>(3).norm(), 2e-4);
  EXPECT_LT(std::abs(error.value[6]), 2e-5);
  const FilterState& last = estimate->frames.back().state;
  EXPECT_LT((last.gyroscope_bias_radps - data.gyroscope_bias).norm(), 1e-4);
  EXPECT_LT((last.accelerometer_bias_mps2 - data.accelerometer_bias).norm(), 1e-2);
}

TEST(BatchEstimate, FindsTheScalesOfTheImu) {
  std::mt19937 random(4);
  MadeUp data = made_up(random, ImuNoise{}, 90);
  const Vector3d gyroscope_scale(0.02, -0.015, 0.01);
  const Vector3d accelerometer_scale(-0.01, 0.015, 0.02);
  for (ImuSample& sample : data.imu) {
    sample.angular_velocity_radps.array() *= 1 + gyroscope_scale.array();
    sample.specific_force_mps2.array() *= 1 + accelerometer_scale.array();
  }
  const BatchInput input = input_of(data, 90, random, 0.0);
  BatchOptions options = calibrating();
  options.gyroscope_scale_prior = 0.03;
  options.accelerometer_scale_prior = 0.03;
  const auto estimate = estimate_batch(input, options);
  ASSERT_TRUE(estimate.has_value());
  EXPECT_LT((estimate->scales.gyroscope - gyroscope_scale).norm(), 2e-4);
  EXPECT_LT((estimate->scales.accelerometer - accelerometer_scale).norm(), 2e-3);
  const auto held = estimate_batch(input, calibrating());
  ASSERT_TRUE(held.has_value());
  EXPECT_EQ(held->scales.gyroscope, Vector3d::Zero());
  EXPECT_EQ(held->common_covariance(kCommonGyroscopeScale, kCommonGyroscopeScale), 0.0);
}

/// Frames with timing measurements whose errors are constant for most of a second: as white noise they would
/// seem three times as accurate.
TEST(BatchEstimate, ATimingIsAsUncertainAsItScattersOverSeconds) {
  constexpr int kFrames = 240;
  constexpr int kRecordings = 10;
  const Vector3d truth_s(0.033, 0.002, -0.004);
  const double sigma_s = 0.001;
  double normalised = 0;
  for (unsigned seed = 1; seed <= kRecordings; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const MadeUp data = made_up(random, kNoise, kFrames);
    BatchInput input = input_of(data, kFrames, random, 1.0);
    Vector3d error = Vector3d::Zero();
    for (std::size_t k = 1; k < kFrames; ++k) {
      if (k % 20 == 1) error = sigma_s * Vector3d(normal(random), normal(random), normal(random));
      VisualTiming timing;
      timing.frame = k;
      timing.root = Matrix3d::Identity() / sigma_s;
      timing.residual = timing.root * (error - truth_s);
      timing.rank = 3;
      input.timing.push_back(timing);
    }
    BatchOptions options = calibrating();
    options.timing_prior_s = Vector3d::Constant(0.015);
    const auto estimate = estimate_batch(input, options);
    ASSERT_TRUE(estimate.has_value());
    const Vector3d variance = estimate->common_covariance.diagonal().segment<3>(kCommonTiming);
    normalised += (estimate->timing_s - truth_s).cwiseAbs2().cwiseQuotient(variance).sum() / kRecordings;
  }
  EXPECT_LT(normalised, 3 + 4 * std::sqrt(2 * 3.0 / kRecordings));
  EXPECT_GT(normalised, 0.5);
}

TEST(BatchEstimate, AnUnobservableTimingKeepsItsPrior) {
  std::mt19937 random(6);
  const MadeUp data = made_up(random, kNoise, 60);
  const BatchInput input = input_of(data, 60, random, 1.0);
  BatchOptions options = calibrating();
  options.timing_prior_s = {0.015, 0, 0.01};
  options.timing_expected_s = {0.004, 0, 0};
  const auto estimate = estimate_batch(input, options);
  ASSERT_TRUE(estimate.has_value());
  EXPECT_NEAR(estimate->timing_s[0], 0.004, 1e-9);
  EXPECT_EQ(estimate->timing_s[1], 0.0);
  EXPECT_NEAR(std::sqrt(estimate->common_covariance(kCommonTiming, kCommonTiming)), 0.015, 1e-9);
  EXPECT_EQ(estimate->common_covariance(kCommonTiming + 1, kCommonTiming + 1), 0.0);
}

TEST(BatchEstimate, TheSameInputGivesTheSameBits) {
  std::mt19937 random(2);
  const MadeUp data = made_up(random, kNoise, 30);
  const BatchInput input = input_of(data, 30, random, 1.0);
  const auto once = estimate_batch(input, calibrating());
  const auto again = estimate_batch(input, calibrating());
  ASSERT_TRUE(once && again);
  EXPECT_EQ(once->T_imu_camera.translation, again->T_imu_camera.translation);
  EXPECT_EQ(once->frames.back().covariance, again->frames.back().covariance);
}

/// Sum of normalised squared errors over many recordings, against the chi-square distribution.
struct Consistency {
  double calibration = 0;  ///< 7 degrees of freedom a recording
  double position = 0;     ///< of the last frame, 3
  double rotation = 0;     ///< 3
  double velocity = 0;     ///< 3
  double biases = 0;       ///< 6
  double variance_factor = 0;
  double correlation_factor = 0;
  double inertial_variance_factor = 0;
};

Consistency consistency(int recordings, int frames, const MadeUp& kind) {
  Consistency mean;
  for (int seed = 1; seed <= recordings; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::normal_distribution<double> normal;
    MadeUp data = kind;
    for (int i = 0; i < 3; ++i) {
      data.gyroscope_bias[i] = 0.005 * normal(random);
      data.accelerometer_bias[i] = 0.05 * normal(random);
    }
    data = made_up(random, kNoise, frames, data);
    BatchInput input = input_of(data, frames, random, 1.0);
    disturb(input);
    const auto estimate = estimate_batch(input, calibrating());
    EXPECT_TRUE(estimate && estimate->converged) << "seed " << seed;
    if (!estimate) continue;
    mean.calibration += calibration_error(*estimate, data).normalised() / recordings;
    const BatchFrame& last = estimate->frames.back();
    const double t = (frames - 1) / kFrameRateHz;
    const SE3 truth = data.motion.T_world_imu(t);
    const auto normalised = [&](int offset, const Eigen::VectorXd& e) {
      return testing::normalised(e, last.covariance.block(offset, offset, e.size(), e.size())) / recordings;
    };
    Vector6d bias;
    bias << last.state.gyroscope_bias_radps - data.gyroscope_bias,
        last.state.accelerometer_bias_mps2 - data.accelerometer_bias;
    mean.rotation +=
        normalised(kRotation, so3_log(truth.rotation.conjugate() * last.state.T_world_imu.rotation));
    mean.position += normalised(kPosition, last.state.T_world_imu.translation - truth.translation);
    mean.velocity += normalised(kVelocity, last.state.velocity_world_mps - data.motion.velocity_world_mps(t));
    mean.biases += normalised(kGyroscopeBias, bias);
    mean.variance_factor += estimate->variance_factor / recordings;
    mean.correlation_factor += estimate->correlation_factor / recordings;
    mean.inertial_variance_factor += estimate->inertial_variance_factor / recordings;
  }
  return mean;
}

/// Mean of 20 chi-square variables within four of its standard deviations.
void expect_chi_square(double mean, double freedom, const char* what) {
  EXPECT_NEAR(mean, freedom, 4 * std::sqrt(2 * freedom / 20)) << what;
}

TEST(BatchEstimate, CovariancesAreHonestWhereTheScaleOfTheImagesIsUnknown) {
  MadeUp kind;
  kind.claimed_sigmas = 4;  // the filter overestimates its uncertainty
  const Consistency mean = consistency(20, 60, kind);
  expect_chi_square(mean.calibration, 7, "calibration");
  expect_chi_square(mean.rotation, 3, "rotation");
  expect_chi_square(mean.position, 3, "position");
  expect_chi_square(mean.velocity, 3, "velocity");
  expect_chi_square(mean.biases, 6, "biases");
  EXPECT_NEAR(mean.variance_factor, 1.0 / 16, 0.15 / 16);
  EXPECT_NEAR(mean.correlation_factor, 1, 0.25);
  EXPECT_NEAR(mean.inertial_variance_factor, 1, 0.1);
}

TEST(BatchEstimate, ErrorsThatLastOverFramesCountMore) {
  MadeUp kind;
  kind.correlation = 0.6;  // long-run variance (1 + 0.6) / (1 - 0.6) = 4
  const Consistency mean = consistency(20, 60, kind);
  EXPECT_GT(mean.correlation_factor, 2.0);
  EXPECT_LT(mean.correlation_factor, 5.0);
  EXPECT_LT(mean.calibration, 2 * 7);
  EXPECT_LT(mean.position, 3 * 3);  // 4 * 3 if they counted as white
}

TEST(BatchEstimate, AnOutlierIsCountedAndDoesNoHarm) {
  std::mt19937 random(4);
  const MadeUp data = made_up(random, kNoise, 60);
  BatchInput input = input_of(data, 60, random, 1.0);
  const auto clean = estimate_batch(input, calibrating());
  input.visual[30].T_reference_camera.translation.x() += 0.05;
  const auto disturbed = estimate_batch(input, calibrating());
  ASSERT_TRUE(clean && disturbed);
  EXPECT_EQ(clean->outliers, 0U);
  EXPECT_EQ(disturbed->outliers, 1U);
  EXPECT_GT(disturbed->frames[31].visual_residual, 10.0);
  EXPECT_LT((disturbed->frames.back().state.T_world_imu.translation -
             clean->frames.back().state.T_world_imu.translation)
                .norm(),
            0.01);  // of 0.05
}

TEST(BatchEstimate, LostFramesAreBridgedAndLessCertain) {
  std::mt19937 random(5);
  const MadeUp data = made_up(random, kNoise, 60);
  BatchInput input = input_of(data, 60, random, 1.0);
  const auto whole = estimate_batch(input, {});
  // Frames 30 to 34 are lost; frame 35 was compared with frame 29.
  RelativeCameraMotion over = input.visual[34];
  over.reference = 29;
  over.covariance *= 6;
  over.T_reference_camera = {Quaterniond::Identity(), Vector3d::Zero()};
  for (std::size_t m = 29; m < 35; ++m)
    over.T_reference_camera = over.T_reference_camera * input.visual[m].T_reference_camera;
  input.visual.erase(input.visual.begin() + 29, input.visual.begin() + 35);
  input.visual.push_back(over);
  const auto bridged = estimate_batch(input, {});
  ASSERT_TRUE(whole && bridged);
  const auto sigma = [](const BatchFrame& frame) {
    return std::sqrt(frame.covariance.block<3, 3>(kPosition, kPosition).trace());
  };
  const double scale = std::sqrt(bridged->variance_factor * bridged->correlation_factor /
                                 (whole->variance_factor * whole->correlation_factor));
  EXPECT_LT(bridged->frames[32].visual_residual, 0);
  EXPECT_GT(sigma(bridged->frames[32]), scale * sigma(whole->frames[32]));
  EXPECT_LT((bridged->frames[32].state.T_world_imu.translation -
             data.motion.T_world_imu(32 / kFrameRateHz).translation)
                .norm(),
            4 * sigma(bridged->frames[32]));
}

/// In slow motion single samples give little information on the change of the rate; their noise must not be
/// used as such.
TEST(BatchEstimate, NoiseIsNotTakenForChangesOfSpeed) {
  MadeUp kind;
  kind.motion.swing_rad = 0.06;
  double normalised = 0;
  constexpr int kRecordings = 6;
  for (unsigned seed = 1; seed <= kRecordings; ++seed) {
    std::mt19937 random(seed);
    const MadeUp data = made_up(random, kNoise, 90, kind);
    BatchInput input = input_of(data, 90, random, 1.0);
    disturb(input);
    const auto estimate = estimate_batch(input, calibrating());
    ASSERT_TRUE(estimate.has_value());
    const double variance = estimate->common_covariance(kCommonTimeOffset, kCommonTimeOffset);
    normalised += std::pow(estimate->time_offset_s - data.time_offset_s, 2) / variance / kRecordings;
  }
  EXPECT_LT(normalised, 3.5);  // chi-square of 6 degrees of freedom: 0.2 % are above
}

/// Rotation about one axis does not determine the position of the IMU along it.
TEST(BatchEstimate, ReportsWhatTheMotionDoesNotDetermine) {
  MadeUp kind;
  kind.motion.axes = {0, 1, 0};
  std::mt19937 random(6);
  const MadeUp data = made_up(random, kNoise, 60, kind);
  BatchInput input = input_of(data, 60, random, 1.0);
  const BatchOptions options = calibrating();
  const auto estimate = estimate_batch(input, options);
  ASSERT_TRUE(estimate.has_value());
  const Matrix3d P = estimate->common_covariance.block<3, 3>(kCommonTranslation, kCommonTranslation);
  EXPECT_GT(std::sqrt(P(1, 1)), 0.9 * options.translation_prior_m);
  EXPECT_LT(std::sqrt(P(0, 0)), 0.2 * options.translation_prior_m);
  EXPECT_LT(std::sqrt(P(2, 2)), 0.2 * options.translation_prior_m);
}

TEST(BatchEstimate, WhatIsHeldFixedStays) {
  std::mt19937 random(7);
  const MadeUp data = made_up(random, kNoise, 30);
  const BatchInput input = input_of(data, 30, random, 1.0);
  const auto estimate = estimate_batch(input, {});
  ASSERT_TRUE(estimate.has_value());
  EXPECT_EQ(estimate->T_imu_camera.translation, input.T_imu_camera.translation);
  EXPECT_EQ(estimate->time_offset_s, input.time_offset_s);
  EXPECT_EQ(estimate->common_covariance(kCommonTimeOffset, kCommonTimeOffset), 0.0);
  EXPECT_GT(estimate->common_covariance(kCommonGravity, kCommonGravity), 0.0);
}

TEST(BatchEstimate, RefusesWhatCannotBeEstimated) {
  std::mt19937 random(8);
  const MadeUp data = made_up(random, kNoise, 30);
  BatchInput input = input_of(data, 30, random, 1.0);
  BatchOptions options;
  options.rotation_prior_rad = -1;
  EXPECT_EQ(estimate_batch(input, options).error().code, ErrorCode::configuration);
  BatchInput without = input;
  without.visual.clear();
  EXPECT_EQ(estimate_batch(without, {}).error().code, ErrorCode::data_corrupt);
  input.imu = input.imu.first(40);
  EXPECT_EQ(estimate_batch(input, {}).error().code, ErrorCode::data_corrupt);
}

}  // namespace
}  // namespace fusebench
