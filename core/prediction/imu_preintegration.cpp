#include "core/prediction/imu_preintegration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/prediction/smoothed_sample.hpp"

namespace fusebench::prediction {

namespace {

// A recording may stop its IMU a little before its camera; holding a sample that long adds less error than a
// frame's worth of constant velocity would.
constexpr std::int64_t kMaxHoldNs = 50'000'000;

// Half the window of smoothed samples: takes away four fifths of the noise at 200 Hz.
constexpr double kSmoothedS = 0.1;

/// The sample at an instant, interpolated linearly or, outside the span, the nearest one.
ImuSample sample_at(std::span<const ImuSample> samples, std::int64_t timestamp_ns) {
  const auto after = std::ranges::lower_bound(samples, timestamp_ns, {}, &ImuSample::timestamp_ns);
  ImuSample result = after == samples.end() ? samples.back() : *after;
  if (after != samples.end() && after != samples.begin() && after->timestamp_ns != timestamp_ns) {
    const ImuSample& before = *(after - 1);
    const double fraction = seconds_between(before.timestamp_ns, timestamp_ns) /
                            seconds_between(before.timestamp_ns, after->timestamp_ns);
    result.angular_velocity_radps =
        before.angular_velocity_radps +
        fraction * (after->angular_velocity_radps - before.angular_velocity_radps);
    result.specific_force_mps2 =
        before.specific_force_mps2 + fraction * (after->specific_force_mps2 - before.specific_force_mps2);
  }
  result.timestamp_ns = timestamp_ns;
  return result;
}

/// The samples within [begin, end] with interpolated ones exactly at both ends.
std::vector<ImuSample> cut(std::span<const ImuSample> samples, std::int64_t begin_ns, std::int64_t end_ns) {
  std::vector<ImuSample> result{sample_at(samples, begin_ns)};
  for (auto it = std::ranges::upper_bound(samples, begin_ns, {}, &ImuSample::timestamp_ns);
       it != samples.end() && it->timestamp_ns < end_ns; ++it) {
    result.push_back(*it);
  }
  result.push_back(sample_at(samples, end_ns));
  return result;
}

/// One mid-point step from sample a to sample b (biases removed). Position first, with the old velocity.
void integrate_step(PreintegratedImu& sum, const ImuSample& a, const ImuSample& b, const ImuNoise& noise) {
  const double dt = seconds_between(a.timestamp_ns, b.timestamp_ns);
  const Vector3d turn = 0.5 * dt * (a.angular_velocity_radps + b.angular_velocity_radps);
  const Matrix3d R0 = sum.delta_rotation.toRotationMatrix();
  const Matrix3d step = so3_exp(turn).toRotationMatrix();
  const Matrix3d R1 = R0 * step;
  const Matrix3d Jr = so3_right_jacobian(turn);
  const Vector3d force = 0.5 * (R0 * a.specific_force_mps2 + R1 * b.specific_force_mps2);

  // Derivative of the mean force by a rotation error before and after the step.
  const Matrix3d force_by_rotation0 = -0.5 * R0 * hat(a.specific_force_mps2);
  const Matrix3d force_by_rotation1 = -0.5 * R1 * hat(b.specific_force_mps2);
  const Matrix3d force_by_noise = -0.5 * (R0 + R1);

  // Bias Jacobians: the chain rule through the same step.
  const Matrix3d rotation1_by_bias = step.transpose() * sum.rotation_by_gyroscope_bias - Jr * dt;
  const Matrix3d force_by_gyroscope_bias =
      force_by_rotation0 * sum.rotation_by_gyroscope_bias + force_by_rotation1 * rotation1_by_bias;
  sum.position_by_gyroscope_bias +=
      dt * sum.velocity_by_gyroscope_bias + 0.5 * dt * dt * force_by_gyroscope_bias;
  sum.position_by_accelerometer_bias +=
      dt * sum.velocity_by_accelerometer_bias + 0.5 * dt * dt * force_by_noise;
  sum.velocity_by_gyroscope_bias += dt * force_by_gyroscope_bias;
  sum.velocity_by_accelerometer_bias += dt * force_by_noise;
  sum.rotation_by_gyroscope_bias = rotation1_by_bias;

  // Covariance of (rotation, velocity, position); white noise of density s has variance s^2 / dt over a step.
  Matrix9d A = Matrix9d::Identity();
  const Matrix3d force_by_rotation = force_by_rotation0 + force_by_rotation1 * step.transpose();
  A.block<3, 3>(0, 0) = step.transpose();
  A.block<3, 3>(3, 0) = dt * force_by_rotation;
  A.block<3, 3>(6, 0) = 0.5 * dt * dt * force_by_rotation;
  A.block<3, 3>(6, 3) = dt * Matrix3d::Identity();
  Eigen::Matrix<double, 9, 6> B = Eigen::Matrix<double, 9, 6>::Zero();
  const Matrix3d rotation_by_noise = -Jr * dt;
  B.block<3, 3>(0, 0) = rotation_by_noise;
  B.block<3, 3>(3, 0) = dt * force_by_rotation1 * rotation_by_noise;
  B.block<3, 3>(6, 0) = 0.5 * dt * dt * force_by_rotation1 * rotation_by_noise;
  B.block<3, 3>(3, 3) = dt * force_by_noise;
  B.block<3, 3>(6, 3) = 0.5 * dt * dt * force_by_noise;
  Vector6d variance;
  variance << Vector3d::Constant(noise.gyroscope_radps_sqrthz * noise.gyroscope_radps_sqrthz / dt),
      Vector3d::Constant(noise.accelerometer_mps2_sqrthz * noise.accelerometer_mps2_sqrthz / dt);
  sum.covariance = A * sum.covariance * A.transpose() + B * variance.asDiagonal() * B.transpose();

  sum.delta_position_m += dt * sum.delta_velocity_mps + 0.5 * dt * dt * force;
  sum.delta_velocity_mps += dt * force;
  sum.delta_rotation = (sum.delta_rotation * so3_exp(turn)).normalized();
  sum.last_step_s = dt;
}

/// Derivative of the increments by a common shift of both instants. With R_begin_s the orientation since the
/// beginning, d/dt_begin R_begin_s = -[w_begin]x R_begin_s, and the end adds the integrand there.
///
/// begin and end are smoothed: where a camera moves slowly single samples are mostly noise, the same noise is
/// in the increments, and an estimate of the offset that ignores this error is biased and overconfident.
void differentiate_by_time_offset(PreintegratedImu& sum, const ImuSample& begin, const ImuSample& end) {
  const Matrix3d R = sum.delta_rotation.toRotationMatrix();
  const Vector3d& rate = begin.angular_velocity_radps;
  const Vector3d& force = begin.specific_force_mps2;
  sum.rotation_by_time_offset = end.angular_velocity_radps - R.transpose() * rate;
  sum.velocity_by_time_offset = R * end.specific_force_mps2 - force - rate.cross(sum.delta_velocity_mps);
  sum.position_by_time_offset =
      sum.delta_velocity_mps - sum.duration_s * force - rate.cross(sum.delta_position_m);
}

}  // namespace

Result<PreintegratedImu> preintegrate(std::span<const ImuSample> samples, std::int64_t begin_ns,
                                      std::int64_t end_ns, const Vector3d& gyroscope_bias_radps,
                                      const Vector3d& accelerometer_bias_mps2, const ImuNoise& noise) {
  check(begin_ns < end_ns, "pre-integration runs forwards in time");
  if (samples.empty() || samples.front().timestamp_ns > begin_ns + kMaxHoldNs ||
      samples.back().timestamp_ns < end_ns - kMaxHoldNs) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format(
            "the IMU does not cover the frames from {:.6f} s to {:.6f} s (its {} samples span {:.6f} s "
            "to {:.6f} s)",
            1e-9 * static_cast<double>(begin_ns), 1e-9 * static_cast<double>(end_ns), samples.size(),
            samples.empty() ? 0.0 : 1e-9 * static_cast<double>(samples.front().timestamp_ns),
            samples.empty() ? 0.0 : 1e-9 * static_cast<double>(samples.back().timestamp_ns)),
        "check that images and IMU share a clock, or choose the frames with --frames A:B");
  }
  std::vector<ImuSample> window = cut(samples, begin_ns, end_ns);
  const auto without_bias = [&](ImuSample sample) {
    sample.angular_velocity_radps -= gyroscope_bias_radps;
    sample.specific_force_mps2 -= accelerometer_bias_mps2;
    return sample;
  };
  for (ImuSample& sample : window) sample = without_bias(sample);
  PreintegratedImu sum;
  sum.duration_s = seconds_between(begin_ns, end_ns);
  for (std::size_t i = 1; i < window.size(); ++i) integrate_step(sum, window[i - 1], window[i], noise);
  differentiate_by_time_offset(sum, without_bias(smoothed_sample(samples, begin_ns, kSmoothedS)),
                               without_bias(smoothed_sample(samples, end_ns, kSmoothedS)));
  const ImuSample& before = window[window.size() - 2];
  sum.angular_velocity_end_radps = window.back().angular_velocity_radps;
  sum.angular_acceleration_end_radps2 =
      (window.back().angular_velocity_radps - before.angular_velocity_radps) / sum.last_step_s;
  return sum;
}

}  // namespace fusebench::prediction
