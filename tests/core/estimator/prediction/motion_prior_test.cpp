#include "core/estimator/prediction/motion_prior.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "core/config/groups/prediction_config.hpp"
#include "tests/support/analytic_motion.hpp"
#include "tests/support/large_matrices.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace config;
using namespace filter;
using namespace prediction;

namespace {

using testing::HelixMotion;
using testing::numeric_jacobian;
using testing::relative_difference;

constexpr std::int64_t kBeginNs = 203'300'000;
constexpr std::int64_t kEndNs = 236'400'000;

GaussianState some_state() {
  GaussianState state;
  FilterState& x = state.mean;
  x.T_world_imu = {so3_exp({0.4, -0.8, 0.3}), {0.1, -0.7, 2.0}};
  x.velocity_world_mps = {0.5, -0.2, 0.1};
  x.gyroscope_bias_radps = {0.01, -0.02, 0.005};
  x.accelerometer_bias_mps2 = {0.1, 0.05, -0.2};
  x.gravity_direction_world = Vector3d(0.2, 0.9, -0.4).normalized();
  x.angular_velocity_imu_radps = {1.0, -0.5, 0.3};
  return state;
}

/// Rates and forces that change all the time, so that no term of a Jacobian vanishes.
std::vector<ImuSample> wobble() {
  std::vector<ImuSample> samples;
  for (int i = 0; i <= 1000; ++i) {
    const double t = 1e-3 * i;
    samples.push_back({static_cast<std::int64_t>(i) * 1'000'000,
                       Vector3d(0.7 * std::sin(3 * t), std::cos(5 * t), 0.4 - t),
                       Vector3d(2 * std::cos(4 * t), -9.5 + t, 3 * std::sin(6 * t))});
  }
  return samples;
}

GaussianState predict_imu(const GaussianState& state, std::span<const ImuSample> samples,
                          const ImuNoise& noise = {}) {
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * state.mean.imu_time_offset_s));
  const auto imu =
      preintegrate(samples, kBeginNs + offset_ns, kEndNs + offset_ns, inertial_errors(state.mean), noise);
  return predict_by_imu(state, *imu, noise, MotionConfig{}).state;
}

/// Numeric F: how the predicted mean moves with the mean.
template <class Predict>
Eigen::MatrixXd numeric_transition(const GaussianState& state, const Predict& predict) {
  const FilterState centre = predict(state).mean;
  return numeric_jacobian(
      [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
        GaussianState moved = state;
        moved.mean = plus(state.mean, StateVector(e));
        return minus(predict(moved).mean, centre);
      },
      kStateSize);
}

TEST(MotionPrior, ImuTransitionEqualsNumericJacobian) {
  const GaussianState state = some_state();
  const auto samples = wobble();
  const auto imu = preintegrate(samples, kBeginNs, kEndNs, inertial_errors(state.mean), {});
  Eigen::MatrixXd F = predict_by_imu(state, *imu, {}, {}).transition;
  Eigen::MatrixXd numeric =
      numeric_transition(state, [&](const GaussianState& s) { return predict_imu(s, samples); });
  // The derivative by the clock is taken from smoothed samples, which follow this wobble to a hundredth.
  const Eigen::VectorXd by_offset = F.col(kImuTimeOffset) - numeric.col(kImuTimeOffset);
  EXPECT_LT(by_offset.norm(), 0.01 * numeric.col(kImuTimeOffset).norm());
  F.col(kImuTimeOffset).setZero();
  numeric.col(kImuTimeOffset).setZero();
  EXPECT_LT(relative_difference(F, numeric), 1e-6);
}

TEST(MotionPrior, ConstantVelocityTransitionEqualsNumericJacobian) {
  const GaussianState state = some_state();
  const auto predict = [](const GaussianState& s) {
    return predict_by_constant_velocity(s, 0.0334, {}).state;
  };
  const StateMatrix F = predict_by_constant_velocity(state, 0.0334, {}).transition;
  EXPECT_LT(relative_difference(F, numeric_transition(state, predict)), 1e-7);
}

constexpr MotionScale kScale{0.04, 0.16};

TEST(MotionPrior, MotionModelTransitionEqualsNumericJacobian) {
  const GaussianState state = some_state();
  const auto predict = [](const GaussianState& s) {
    return predict_by_motion_model(s, 0.0334, kScale, {}).state;
  };
  const StateMatrix F = predict_by_motion_model(state, 0.0334, kScale, {}).transition;
  EXPECT_LT(relative_difference(F, numeric_transition(state, predict)), 1e-7);
}

TEST(MotionPrior, ImuPredictionFollowsClosedFormMotion) {
  const HelixMotion motion;
  GaussianState state;
  state.mean.T_world_imu = motion.T_world_imu(1e-9 * kBeginNs);
  state.mean.velocity_world_mps = motion.velocity_world_mps(1e-9 * kBeginNs);
  state.mean.gravity_direction_world = motion.gravity_world_mps2.normalized();
  const FilterState predicted = predict_imu(state, motion.samples(0, 1, 200)).mean;
  const SE3 truth = motion.T_world_imu(1e-9 * kEndNs);
  EXPECT_LT((predicted.T_world_imu.translation - truth.translation).norm(), 1e-6);
  EXPECT_LT(rotation_angle_rad(predicted.T_world_imu.rotation, truth.rotation), 1e-10);
  EXPECT_LT((predicted.velocity_world_mps - motion.velocity_world_mps(1e-9 * kEndNs)).norm(), 1e-4);
  EXPECT_LT((predicted.angular_velocity_imu_radps - motion.body_rate_radps).norm(), 1e-12);
}

TEST(MotionPrior, MotionModelDoesNotDependOnTheDivisionOfTime) {
  const MotionConfig config;
  GaussianState state;  // at rest, so that the chain of transitions is exact
  const GaussianState whole = predict_by_motion_model(state, 0.4, kScale, config).state;
  GaussianState steps = state;
  for (int i = 0; i < 10; ++i) steps = predict_by_motion_model(steps, 0.04, kScale, config).state;
  EXPECT_LT(testing::relative_distance(steps.covariance, whole.covariance), 1e-10);
}

TEST(MotionPrior, MotionModelIsAnOrnsteinUhlenbeckProcess) {
  const MotionConfig config;
  GaussianState state;
  state.mean.velocity_world_mps = {0.3, 0, 0};
  // For long times the velocity has its stationary variance, and the camera stopped after tau * v.
  const GaussianState late = predict_by_motion_model(state, 100, kScale, config).state;
  EXPECT_NEAR(late.covariance(kVelocity, kVelocity), kScale.speed_m2ps2, 1e-12);
  EXPECT_NEAR(late.covariance(kAngularVelocity, kAngularVelocity), kScale.rate_rad2ps2, 1e-12);
  EXPECT_NEAR(late.mean.T_world_imu.translation.x(), 0.3 * config.speed_time_s, 1e-12);
  // For short times it is white acceleration of density sqrt(2 var / tau).
  constexpr double kShort_s = 1e-3;
  const GaussianState soon = predict_by_motion_model(state, kShort_s, kScale, config).state;
  const double density2 = 2 * kScale.speed_m2ps2 / config.speed_time_s;
  EXPECT_NEAR(soon.covariance(kVelocity, kVelocity) / (density2 * kShort_s), 1, 2e-3);
  EXPECT_NEAR(soon.covariance(kPosition, kPosition) / (density2 * kShort_s * kShort_s * kShort_s / 3), 1,
              2e-3);
}

TEST(MotionPrior, ProcessNoiseOfConstantVelocityIsThatOfIntegratedWhiteAcceleration) {
  // Two half steps give the same covariance as one whole step: the noise is a property of time, not of
  // frames.
  MotionConfig config;
  GaussianState state;  // at rest, so that the chain of transitions is exact
  const GaussianState whole = predict_by_constant_velocity(state, 0.04, config).state;
  const GaussianState halves =
      predict_by_constant_velocity(predict_by_constant_velocity(state, 0.02, config).state, 0.02, config)
          .state;
  EXPECT_LT(testing::relative_distance(halves.covariance, whole.covariance), 1e-12);
  const double q = config.acceleration_noise_mps2_sqrthz;
  EXPECT_NEAR(whole.covariance(kPosition, kPosition), q * q * 0.04 * 0.04 * 0.04 / 3, 1e-15);
}

TEST(MotionPrior, ScaleFollowsTheVelocitiesOfTheRecording) {
  const MotionConfig config;
  MotionScale scale = initial_motion_scale(config);
  EXPECT_NEAR(scale.speed_m2ps2, config.speed_mps * config.speed_mps, 1e-15);
  FilterState state;
  state.velocity_world_mps = {1, 1, 1};
  state.angular_velocity_imu_radps = {0, 0, 0};
  for (double t_s = 0; t_s < config.scale_time_s; t_s += 0.1)
    scale = followed_scale(scale, state, 0.1, config);
  const double forgotten = std::exp(-1.0);
  EXPECT_NEAR(scale.speed_m2ps2, 1 + forgotten * (config.speed_mps * config.speed_mps - 1), 0.01);
  EXPECT_NEAR(scale.rate_rad2ps2, forgotten * config.rate_radps * config.rate_radps, 0.01);
}

TEST(MotionPrior, CovariancesStaySymmetricAndPositive) {
  GaussianState state = some_state();
  state.covariance.diagonal().setConstant(1e-4);
  const ImuNoise noise{1e-3, 2e-2, 5e-5, 6e-4};
  const auto samples = wobble();
  for (int i = 0; i < 50; ++i) state.covariance = predict_imu(state, samples, noise).covariance;
  const Eigen::MatrixXd covariance = state.covariance;
  EXPECT_EQ((covariance - covariance.transpose()).cwiseAbs().maxCoeff(), 0.0);
  EXPECT_GT(testing::smallest_eigenvalue(covariance), 0.0);
}

}  // namespace
}  // namespace fusebench
