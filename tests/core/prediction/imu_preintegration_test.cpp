#include "core/prediction/imu_preintegration.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/support/analytic_motion.hpp"
#include "tests/support/numeric_jacobian.hpp"

namespace fusebench {

using namespace prediction;

namespace {

using testing::HelixMotion;
using testing::numeric_jacobian;
using testing::relative_difference;

const Vector3d kNone = Vector3d::Zero();

PreintegratedImu integrate(std::span<const ImuSample> samples, double begin_s, double end_s,
                           const Vector3d& bg = kNone, const Vector3d& ba = kNone,
                           const ImuNoise& noise = {}) {
  const auto ns = [](double s) { return static_cast<std::int64_t>(std::llround(1e9 * s)); };
  const auto result = preintegrate(samples, ns(begin_s), ns(end_s), bg, ba, noise);
  EXPECT_TRUE(result.has_value());
  return result.value_or(PreintegratedImu{});
}

/// Position and velocity errors after carrying the true state over [begin, end] by the increments.
struct Drift {
  double rotation_rad, velocity_mps, position_m;
};
Drift drift(const HelixMotion& motion, const PreintegratedImu& imu, double begin_s, double end_s) {
  const SE3 T0 = motion.T_world_imu(begin_s);
  const Vector3d v0 = motion.velocity_world_mps(begin_s);
  const double dt = end_s - begin_s;
  const Vector3d g = motion.gravity_world_mps2;
  const SE3 T1 = motion.T_world_imu(end_s);
  return {rotation_angle_rad(T0.rotation * imu.delta_rotation, T1.rotation),
          (v0 + g * dt + T0.rotation * imu.delta_velocity_mps - motion.velocity_world_mps(end_s)).norm(),
          (T0.translation + v0 * dt + 0.5 * g * dt * dt + T0.rotation * imu.delta_position_m - T1.translation)
              .norm()};
}

TEST(ImuPreintegration, FollowsClosedFormMotionBetweenArbitraryInstants) {
  const HelixMotion motion;
  // The instants fall between samples: the ends must be interpolated exactly.
  const double begin = 0.1234567;
  const double end = 0.4567891;
  const Drift d = drift(motion, integrate(motion.samples(0, 1, 1000), begin, end), begin, end);
  EXPECT_LT(d.rotation_rad, 1e-12);  // constant body rate: exact
  EXPECT_LT(d.velocity_mps, 2e-6);
  EXPECT_LT(d.position_m, 5e-7);
}

TEST(ImuPreintegration, ErrorFallsWithTheSquareOfTheSampleSpacing) {
  const HelixMotion motion;
  const Drift coarse = drift(motion, integrate(motion.samples(0, 1, 100), 0.1, 0.9), 0.1, 0.9);
  const Drift fine = drift(motion, integrate(motion.samples(0, 1, 200), 0.1, 0.9), 0.1, 0.9);
  EXPECT_NEAR(coarse.velocity_mps / fine.velocity_mps, 4.0, 0.2);
  EXPECT_NEAR(coarse.position_m / fine.position_m, 4.0, 0.2);
}

TEST(ImuPreintegration, IsAdditiveOverASplit) {
  const HelixMotion motion;
  const auto samples = motion.samples(0, 1, 200);
  const PreintegratedImu whole = integrate(samples, 0.1, 0.5);
  const PreintegratedImu first = integrate(samples, 0.1, 0.3);
  const PreintegratedImu second = integrate(samples, 0.3, 0.5);
  EXPECT_LT(rotation_angle_rad(whole.delta_rotation, first.delta_rotation * second.delta_rotation), 1e-12);
  EXPECT_LT(
      (whole.delta_velocity_mps - first.delta_velocity_mps - first.delta_rotation * second.delta_velocity_mps)
          .norm(),
      1e-12);
}

TEST(ImuPreintegration, BiasJacobiansEqualNumericOnes) {
  const HelixMotion motion;
  const auto samples = motion.samples(0, 1, 200);
  const Vector3d bg(0.02, -0.01, 0.03);
  const Vector3d ba(0.1, 0.2, -0.1);
  const PreintegratedImu at = integrate(samples, 0.2, 0.6, bg, ba);
  const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    const PreintegratedImu moved = integrate(samples, 0.2, 0.6, bg + e.head<3>(), ba + e.tail<3>());
    Eigen::VectorXd result(9);
    result << so3_log(at.delta_rotation.conjugate() * moved.delta_rotation), moved.delta_velocity_mps,
        moved.delta_position_m;
    return result;
  };
  Eigen::MatrixXd analytic = Eigen::MatrixXd::Zero(9, 6);
  analytic.block<3, 3>(0, 0) = at.rotation_by_gyroscope_bias;
  analytic.block<3, 3>(3, 0) = at.velocity_by_gyroscope_bias;
  analytic.block<3, 3>(3, 3) = at.velocity_by_accelerometer_bias;
  analytic.block<3, 3>(6, 0) = at.position_by_gyroscope_bias;
  analytic.block<3, 3>(6, 3) = at.position_by_accelerometer_bias;
  EXPECT_LT(relative_difference(analytic, numeric_jacobian(f, 6)), 1e-8);
}

TEST(ImuPreintegration, CovarianceEqualsMonteCarlo) {
  const HelixMotion motion;
  const double rate_hz = 200;
  const ImuNoise noise{.gyroscope_radps_sqrthz = 0.02, .accelerometer_mps2_sqrthz = 0.3};
  const auto clean = motion.samples(0, 0.4, rate_hz);
  const PreintegratedImu mean = integrate(clean, 0.1, 0.3, kNone, kNone, noise);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  Matrix9d sampled = Matrix9d::Zero();
  const int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    auto noisy = clean;
    for (ImuSample& s : noisy) {
      for (int k = 0; k < 3; ++k) {
        s.angular_velocity_radps[k] += noise.gyroscope_radps_sqrthz * std::sqrt(rate_hz) * normal(generator);
        s.specific_force_mps2[k] += noise.accelerometer_mps2_sqrthz * std::sqrt(rate_hz) * normal(generator);
      }
    }
    const PreintegratedImu moved = integrate(noisy, 0.1, 0.3);
    Eigen::Matrix<double, 9, 1> e;
    e << so3_log(mean.delta_rotation.conjugate() * moved.delta_rotation),
        moved.delta_velocity_mps - mean.delta_velocity_mps, moved.delta_position_m - mean.delta_position_m;
    sampled += e * e.transpose() / trials;
  }
  for (int i = 0; i < 9; ++i) {
    EXPECT_NEAR(std::sqrt(sampled(i, i) / mean.covariance(i, i)), 1.0, 0.08) << "component " << i;
  }
}

TEST(ImuPreintegration, RefusesFramesThatTheImuDoesNotCover) {
  const HelixMotion motion;
  const auto samples = motion.samples(1, 2, 200);
  const auto late = preintegrate(samples, 1'900'000'000, 2'200'000'000, kNone, kNone, {});
  ASSERT_FALSE(late.has_value());
  EXPECT_EQ(late.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(late.error().message.find("2.200000 s"), std::string::npos);
  EXPECT_FALSE(preintegrate(samples, 800'000'000, 1'200'000'000, kNone, kNone, {}).has_value());
  EXPECT_FALSE(preintegrate({}, 0, 1, kNone, kNone, {}).has_value());
  EXPECT_TRUE(preintegrate(samples, 1'900'000'000, 2'040'000'000, kNone, kNone, {}).has_value());
}

}  // namespace
}  // namespace fusebench
