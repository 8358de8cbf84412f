#include "core/estimator/prediction/imu_preintegration.hpp"

#include <gtest/gtest.h>

#include <array>
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
                           const InertialErrors& errors = {}, const ImuNoise& noise = {}) {
  const auto ns = [](double s) { return static_cast<std::int64_t>(std::llround(1e9 * s)); };
  const auto result = preintegrate(samples, ns(begin_s), ns(end_s), errors, noise);
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

InertialErrors some_errors() {
  return {
      {0.02, -0.01, 0.03}, {0.1, 0.2, -0.1}, {0.02, -0.03, 0.01}, {0.02, -0.01, 0.03}, {-0.02, 0.01, 0.02}};
}

TEST(ImuPreintegration, ErrorJacobiansEqualNumericOnes) {
  const HelixMotion motion;
  const auto samples = motion.samples(0, 1, 200);
  const InertialErrors errors = some_errors();
  const PreintegratedImu at = integrate(samples, 0.2, 0.6, errors);
  const auto f = [&](const Eigen::VectorXd& e) -> Eigen::VectorXd {
    const InertialErrors more{errors.gyroscope_bias_radps + e.segment<3>(0),
                              errors.accelerometer_bias_mps2 + e.segment<3>(3),
                              errors.rotation_rad + e.segment<3>(6), errors.gyroscope_scale + e.segment<3>(9),
                              errors.accelerometer_scale + e.segment<3>(12)};
    const PreintegratedImu moved = integrate(samples, 0.2, 0.6, more);
    Eigen::VectorXd result(12);
    result << so3_log(at.delta_rotation.conjugate() * moved.delta_rotation), moved.delta_velocity_mps,
        moved.delta_position_m, moved.angular_velocity_end_radps;
    return result;
  };
  Eigen::MatrixXd analytic(12, kInertialErrors);
  analytic << at.rotation_by_errors, at.velocity_by_errors, at.position_by_errors,
      at.angular_velocity_end_by_errors;
  EXPECT_LT(relative_difference(analytic, numeric_jacobian(f, kInertialErrors)), 1e-7);
}

TEST(ImuPreintegration, CorrectionUndoesTheErrorsOfASample) {
  const InertialErrors errors = some_errors();
  const Vector3d rate(0.4, -1.1, 0.7);
  const Vector3d force(1.5, -9.2, 2.0);
  const auto measured = [&](const Vector3d& value, const Vector3d& bias, const Vector3d& scale) -> Vector3d {
    const Vector3d in_its_axes = so3_exp(errors.rotation_rad).conjugate() * (value + bias);
    return (1.0 + scale.array()) * in_its_axes.array();
  };
  const ImuSample sample =
      corrected({0, measured(rate, errors.gyroscope_bias_radps, errors.gyroscope_scale),
                 measured(force, errors.accelerometer_bias_mps2, errors.accelerometer_scale)},
                errors);
  EXPECT_LT((sample.angular_velocity_radps - rate).norm(), 1e-14);
  EXPECT_LT((sample.specific_force_mps2 - force).norm(), 1e-14);
}

TEST(ImuPreintegration, CovarianceEqualsMonteCarlo) {
  const HelixMotion motion;
  const double rate_hz = 200;
  const ImuNoise noise{.gyroscope_radps_sqrthz = 0.02, .accelerometer_mps2_sqrthz = 0.3};
  const auto clean = motion.samples(0, 0.4, rate_hz);
  const PreintegratedImu mean = integrate(clean, 0.1, 0.3, {}, noise);
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

/// The increments of one trial of the Monte Carlo test.
struct Increments {
  Matrix3d R = Matrix3d::Identity();
  Vector3d velocity_mps = Vector3d::Zero();
  Vector3d position_m = Vector3d::Zero();
};

/// The mid-point rule, written again: over each step the rate and the force are the means of both samples,
/// and independent noise of variance density^2 / dt is added to the rate and, in the body's axes, to the
/// force.
template <typename Draw>
Increments integrate_with_noise(std::span<const ImuSample> samples, const ImuNoise& noise, Draw&& draw) {
  Increments sum;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = 1e-9 * static_cast<double>(samples[i].timestamp_ns - samples[i - 1].timestamp_ns);
    const Vector3d rate_noise = noise.gyroscope_radps_sqrthz / std::sqrt(dt) * draw();
    const Vector3d force_noise = noise.accelerometer_mps2_sqrthz / std::sqrt(dt) * draw();
    const Vector3d turn =
        dt * (0.5 * (samples[i - 1].angular_velocity_radps + samples[i].angular_velocity_radps) + rate_noise);
    const Matrix3d R1 = sum.R * Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    const Vector3d force = 0.5 * (sum.R * (samples[i - 1].specific_force_mps2 + force_noise) +
                                  R1 * (samples[i].specific_force_mps2 + force_noise));
    sum.position_m += dt * sum.velocity_mps + 0.5 * dt * dt * force;
    sum.velocity_mps += dt * force;
    sum.R = R1;
  }
  return sum;
}

// A few steps of one sensor's noise: over many steps, or with both, the terms in dt^2 drown in the others.
TEST(ImuPreintegration, CovarianceOfFewStepsEqualsIndependentMonteCarlo) {
  const HelixMotion motion;
  const double rate_hz = 100;
  const std::array<ImuNoise, 3> noises = {
      ImuNoise{.gyroscope_radps_sqrthz = 0.01, .accelerometer_mps2_sqrthz = 0},
      ImuNoise{.gyroscope_radps_sqrthz = 0, .accelerometer_mps2_sqrthz = 0.1},
      ImuNoise{.gyroscope_radps_sqrthz = 0.01, .accelerometer_mps2_sqrthz = 0.1}};
  constexpr int kTrials = 20'000;
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  const auto draw = [&] {
    const double x = normal(generator);
    const double y = normal(generator);
    return Vector3d(x, y, normal(generator));
  };
  for (const ImuNoise& noise : noises) {
    for (const int steps : {1, 2, 4}) {
      const auto samples = motion.samples(0, steps / rate_hz, rate_hz);
      ASSERT_EQ(samples.size(), static_cast<std::size_t>(steps) + 1);
      const Increments mean = integrate_with_noise(samples, {0, 0}, [] { return Vector3d(0, 0, 0); });
      Matrix9d sampled = Matrix9d::Zero();
      for (int trial = 0; trial < kTrials; ++trial) {
        const Increments one = integrate_with_noise(samples, noise, draw);
        const Eigen::AngleAxisd turned(mean.R.transpose() * one.R);
        Eigen::Matrix<double, 9, 1> e;
        e << turned.angle() * turned.axis(), one.velocity_mps - mean.velocity_mps,
            one.position_m - mean.position_m;
        sampled += e * e.transpose() / kTrials;
      }
      const Matrix9d C = integrate(samples, 0, steps / rate_hz, {}, noise).covariance;
      for (int i = 0; i < 9; ++i) {
        for (int j = 0; j < 9; ++j) {
          // Standard deviation of a sample covariance of normal errors. The floor is for variances of zero.
          const double sigma = std::sqrt((C(i, i) * C(j, j) + C(i, j) * C(i, j)) / kTrials);
          const double scale = std::sqrt(sampled(i, i) * sampled(j, j));
          EXPECT_NEAR(sampled(i, j), C(i, j), 5.0 * sigma + 1e-4 * scale)
              << "(" << i << ", " << j << ") after " << steps << " steps, gyroscope "
              << noise.gyroscope_radps_sqrthz << ", accelerometer " << noise.accelerometer_mps2_sqrthz;
        }
      }
    }
  }
}

// The rate at the end is the middle of a parabola through the samples around it (Savitzky & Golay 1964).
TEST(ImuPreintegration, TheRateAtTheEndHasTheNoiseOfAMeanOverTheTimeThatIsGiven) {
  const HelixMotion motion;
  const double rate_hz = 500;
  const double density = 0.02;
  const auto clean = motion.samples(0, 0.4, rate_hz);
  const PreintegratedImu mean = integrate(clean, 0.1, 0.2);
  std::mt19937_64 generator(4);
  std::normal_distribution<double> normal;
  double squares = 0;
  constexpr int kTrials = 2000;
  for (int trial = 0; trial < kTrials; ++trial) {
    auto noisy = clean;
    for (ImuSample& sample : noisy) {
      for (int k = 0; k < 3; ++k)
        sample.angular_velocity_radps[k] += density * std::sqrt(rate_hz) * normal(generator);
    }
    const Vector3d error =
        integrate(noisy, 0.1, 0.2).angular_velocity_end_radps - mean.angular_velocity_end_radps;
    squares += error.squaredNorm() / (3 * kTrials);
  }
  // A sample's share in a window of 41 differs from the continuous rule by some percent.
  EXPECT_NEAR(squares / (density * density / mean.rate_averaged_s), 1.0, 0.1);
}

TEST(ImuPreintegration, RefusesFramesThatTheImuDoesNotCover) {
  const HelixMotion motion;
  const auto samples = motion.samples(1, 2, 200);
  const auto late = preintegrate(samples, 1'900'000'000, 2'200'000'000, {}, {});
  ASSERT_FALSE(late.has_value());
  EXPECT_EQ(late.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(late.error().message.find("2.200000 s"), std::string::npos);
  EXPECT_FALSE(preintegrate(samples, 800'000'000, 1'200'000'000, {}, {}).has_value());
  EXPECT_FALSE(preintegrate({}, 0, 1, {}, {}).has_value());
  EXPECT_TRUE(preintegrate(samples, 1'900'000'000, 2'040'000'000, {}, {}).has_value());
}

}  // namespace
}  // namespace fusebench
