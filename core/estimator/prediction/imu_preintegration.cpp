#include "core/estimator/prediction/imu_preintegration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/estimator/prediction/smoothed_sample.hpp"

namespace fusebench::prediction {

namespace {

// The IMU of a recording may stop a little before its camera. Holding a sample for this time adds less error
// than constant velocity over a frame.
constexpr std::int64_t kMaxHoldNs = 50'000'000;

// Half the window of smoothed samples: removes four fifths of the noise at 200 Hz.
constexpr double kSmoothedS = 0.1;

// Half the window for the rate at a frame, used for the compensation of its rows: removes two thirds of the
// noise at 200 Hz, with an error of 1 % for motion at 4 Hz.
constexpr double kRateWindow_s = 0.04;

/// The sample at an instant, by linear interpolation; outside the span, the nearest one.
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

/// The samples within [begin, end], with interpolated samples exactly at both ends.
std::vector<ImuSample> cut(std::span<const ImuSample> samples, std::int64_t begin_ns, std::int64_t end_ns) {
  std::vector<ImuSample> result{sample_at(samples, begin_ns)};
  for (auto it = std::ranges::upper_bound(samples, begin_ns, {}, &ImuSample::timestamp_ns);
       it != samples.end() && it->timestamp_ns < end_ns; ++it) {
    result.push_back(*it);
  }
  result.push_back(sample_at(samples, end_ns));
  return result;
}

/// A corrected sample and its derivatives by the IMU errors.
struct CorrectedSample {
  CorrectedSample(const ImuSample& measured, const InertialErrors& errors)
      : sample(corrected(measured, errors)), R(so3_exp(errors.rotation_rad).toRotationMatrix()) {
    const Matrix3d by_rotation = so3_right_jacobian(-errors.rotation_rad);  // on the left of Exp(rotation)
    const Vector3d rate = sample.angular_velocity_radps + errors.gyroscope_bias_radps;
    const Vector3d force = sample.specific_force_mps2 + errors.accelerometer_bias_mps2;
    const auto by_scale = [&](const Vector3d& value, const Vector3d& scale) -> Matrix3d {
      return -R * ((R.transpose() * value).array() / (1.0 + scale.array())).matrix().asDiagonal();
    };
    rate_by_errors << -Matrix3d::Identity(), Matrix3d::Zero(), -hat(rate) * by_rotation,
        by_scale(rate, errors.gyroscope_scale), Matrix3d::Zero();
    force_by_errors << Matrix3d::Zero(), -Matrix3d::Identity(), -hat(force) * by_rotation, Matrix3d::Zero(),
        by_scale(force, errors.accelerometer_scale);
  }

  ImuSample sample;
  Matrix3d R;
  ByInertialErrors rate_by_errors;
  ByInertialErrors force_by_errors;
};

/// One mid-point step between two samples. Updates the position first, with the old velocity.
void integrate_step(PreintegratedImu& sum, const CorrectedSample& from, const CorrectedSample& to,
                    const ImuNoise& noise) {
  const ImuSample& a = from.sample;
  const ImuSample& b = to.sample;
  const double dt = seconds_between(a.timestamp_ns, b.timestamp_ns);
  const Vector3d turn = 0.5 * dt * (a.angular_velocity_radps + b.angular_velocity_radps);
  const Matrix3d R0 = sum.delta_rotation.toRotationMatrix();
  const Matrix3d step = so3_exp(turn).toRotationMatrix();
  const Matrix3d R1 = R0 * step;
  const Matrix3d Jr = so3_right_jacobian(turn);
  const Vector3d force = 0.5 * (R0 * a.specific_force_mps2 + R1 * b.specific_force_mps2);

  // Derivatives of the mean force by a rotation error at the start and the end of the step.
  const Matrix3d force_by_rotation0 = -0.5 * R0 * hat(a.specific_force_mps2);
  const Matrix3d force_by_rotation1 = -0.5 * R1 * hat(b.specific_force_mps2);
  const Matrix3d force_by_noise = -0.5 * (R0 + R1);

  // Derivatives by the IMU errors: chain rule through the step.
  const ByInertialErrors rotation1_by_errors =
      step.transpose() * sum.rotation_by_errors + 0.5 * dt * Jr * (from.rate_by_errors + to.rate_by_errors);
  const ByInertialErrors force_by_errors = force_by_rotation0 * sum.rotation_by_errors +
                                           force_by_rotation1 * rotation1_by_errors +
                                           0.5 * (R0 * from.force_by_errors + R1 * to.force_by_errors);
  sum.position_by_errors += dt * sum.velocity_by_errors + 0.5 * dt * dt * force_by_errors;
  sum.velocity_by_errors += dt * force_by_errors;
  sum.rotation_by_errors = rotation1_by_errors;

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
/// begin, d/dt_begin R_begin_s = -[w_begin]x R_begin_s; the end adds the integrand.
///
/// begin and end are smoothed. In slow motion single samples are mostly noise, which the increments contain
/// too. An offset estimate that ignores this correlation is biased and overconfident.
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

ImuSample corrected(const ImuSample& sample, const InertialErrors& errors) {
  const Quaterniond R = so3_exp(errors.rotation_rad);
  ImuSample result = sample;
  result.angular_velocity_radps =
      R * (sample.angular_velocity_radps.array() / (1.0 + errors.gyroscope_scale.array())).matrix() -
      errors.gyroscope_bias_radps;
  result.specific_force_mps2 =
      R * (sample.specific_force_mps2.array() / (1.0 + errors.accelerometer_scale.array())).matrix() -
      errors.accelerometer_bias_mps2;
  return result;
}

Result<PreintegratedImu> preintegrate(std::span<const ImuSample> samples, std::int64_t begin_ns,
                                      std::int64_t end_ns, const InertialErrors& errors,
                                      const ImuNoise& noise) {
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
  std::vector<CorrectedSample> window;
  for (const ImuSample& sample : cut(samples, begin_ns, end_ns)) window.emplace_back(sample, errors);
  PreintegratedImu sum;
  sum.duration_s = seconds_between(begin_ns, end_ns);
  for (std::size_t i = 1; i < window.size(); ++i) integrate_step(sum, window[i - 1], window[i], noise);
  differentiate_by_time_offset(sum, corrected(smoothed_sample(samples, begin_ns, kSmoothedS), errors),
                               corrected(smoothed_sample(samples, end_ns, kSmoothedS), errors));
  const ImuSample& before = window[window.size() - 2].sample;
  const CorrectedSample end(smoothed_sample(samples, end_ns, kRateWindow_s), errors);
  // The value of a fitted parabola at its middle has 9/4 of the variance of a mean (Savitzky & Golay 1964).
  sum.rate_averaged_s = 2 * kRateWindow_s * 4 / 9;
  sum.angular_velocity_end_radps = end.sample.angular_velocity_radps;
  sum.angular_velocity_end_by_errors = end.rate_by_errors;
  sum.angular_acceleration_end_radps2 =
      (window.back().sample.angular_velocity_radps - before.angular_velocity_radps) / sum.last_step_s;
  return sum;
}

}  // namespace fusebench::prediction
