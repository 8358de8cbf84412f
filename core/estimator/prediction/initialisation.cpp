#include "core/estimator/prediction/initialisation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/estimator/filter/moved_state.hpp"
#include "core/estimator/prediction/smoothed_sample.hpp"
#include "core/estimator/prediction/timing_prior.hpp"

namespace fusebench::prediction {

namespace {

struct WindowStatistics {
  Vector3d mean_angular_velocity_radps = Vector3d::Zero();
  Vector3d mean_specific_force_mps2 = Vector3d::Zero();  ///< in the IMU frame at the first frame
  double gyroscope_std_radps = 0;
  double accelerometer_std_mps2 = 0;
};

/// Means over the window, each force rotated into the IMU frame at the first frame.
WindowStatistics window_statistics(std::span<const ImuSample> window, std::int64_t first_frame_ns) {
  const double count = static_cast<double>(window.size());
  // Orientation of each sample relative to the first of the window, then relative to the first frame.
  std::vector<Quaterniond> R_begin_imu(window.size(), Quaterniond::Identity());
  std::size_t at_frame = 0;
  for (std::size_t i = 1; i < window.size(); ++i) {
    const double dt = seconds_between(window[i - 1].timestamp_ns, window[i].timestamp_ns);
    R_begin_imu[i] =
        R_begin_imu[i - 1] *
        so3_exp(0.5 * dt * (window[i - 1].angular_velocity_radps + window[i].angular_velocity_radps));
    if (window[i].timestamp_ns <= first_frame_ns) at_frame = i;
  }
  WindowStatistics s;
  Vector3d raw_force = Vector3d::Zero();
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Quaterniond R_first_imu = R_begin_imu[at_frame].conjugate() * R_begin_imu[i];
    s.mean_specific_force_mps2 += R_first_imu * window[i].specific_force_mps2 / count;
    s.mean_angular_velocity_radps += window[i].angular_velocity_radps / count;
    raw_force += window[i].specific_force_mps2 / count;
  }
  double gyroscope_variance = 0;
  double accelerometer_variance = 0;
  for (const ImuSample& sample : window) {
    gyroscope_variance +=
        (sample.angular_velocity_radps - s.mean_angular_velocity_radps).squaredNorm() / count;
    accelerometer_variance += (sample.specific_force_mps2 - raw_force).squaredNorm() / count;
  }
  s.gyroscope_std_radps = std::sqrt(gyroscope_variance / 3.0);
  s.accelerometer_std_mps2 = std::sqrt(accelerometer_variance / 3.0);
  return s;
}

void set_variance(filter::GaussianState& state, int offset, int size, double sigma) {
  state.covariance.diagonal().segment(offset, size).setConstant(sigma * sigma);
}

}  // namespace

Result<filter::GaussianState> initialise_with_imu(std::span<const ImuSample> samples,
                                                  std::int64_t first_frame_ns, const SensorRig& rig,
                                                  const config::InitialisationConfig& config) {
  const std::span<const ImuSample> window = samples_around(samples, first_frame_ns, config.window_s);
  if (window.size() < 2) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("no IMU samples within {} s of the first frame at {:.6f} s", config.window_s,
                            1e-9 * static_cast<double>(first_frame_ns)),
                "check that images and IMU share a clock, or start later with --frames A:B");
  }
  const WindowStatistics s = window_statistics(window, first_frame_ns);
  const bool at_rest = s.gyroscope_std_radps < config.rest_gyroscope_std_radps &&
                       s.accelerometer_std_mps2 < config.rest_accelerometer_std_mps2 &&
                       s.mean_angular_velocity_radps.norm() < 10.0 * config.gyroscope_bias_sigma_radps;

  filter::GaussianState state;
  state.mean.T_world_imu = rig.T_imu_camera.inverse();  // world = first camera frame
  const Matrix3d R_world_imu = state.mean.T_world_imu.rotation_matrix();
  state.mean.gravity_direction_world = -(R_world_imu * s.mean_specific_force_mps2).normalized();
  if (at_rest) state.mean.gyroscope_bias_radps = s.mean_angular_velocity_radps;
  const auto now =
      std::min_element(window.begin(), window.end(), [&](const ImuSample& a, const ImuSample& b) {
        return std::abs(a.timestamp_ns - first_frame_ns) < std::abs(b.timestamp_ns - first_frame_ns);
      });
  state.mean.angular_velocity_imu_radps = now->angular_velocity_radps - state.mean.gyroscope_bias_radps;

  // The pose is exact by definition. Tilt and accelerometer bias are not separately observable at rest, so
  // the uncertainty of gravity follows from that of the bias.
  const double tilt_sigma = config.accelerometer_bias_sigma_mps2 / kGravity_mps2;
  const double rest_bias_sigma = s.gyroscope_std_radps / std::sqrt(static_cast<double>(window.size())) + 1e-4;
  set_variance(state, filter::kVelocity, 3,
               at_rest ? config.rest_velocity_sigma_mps : config.moving_velocity_sigma_mps);
  set_variance(state, filter::kGyroscopeBias, 3,
               at_rest ? rest_bias_sigma : config.gyroscope_bias_sigma_radps);
  set_variance(state, filter::kAccelerometerBias, 3, config.accelerometer_bias_sigma_mps2);
  set_variance(state, filter::kGravity, 2,
               at_rest ? tilt_sigma : std::hypot(tilt_sigma, config.moving_gravity_sigma_rad));
  set_variance(state, filter::kAngularVelocity, 3, config.gyroscope_bias_sigma_radps);
  return state;
}

void set_imu_priors(filter::GaussianState& state, const config::SelfCalibrationConfig& config) {
  set_variance(state, filter::kImuRotation, 3, config.imu_rotation_sigma_rad);
  set_variance(state, filter::kGyroscopeScale, 3, config.gyroscope_scale_sigma);
  set_variance(state, filter::kAccelerometerScale, 3, config.accelerometer_scale_sigma);
}

filter::GaussianState initialise_without_imu(const config::InitialisationConfig& config) {
  filter::GaussianState state;
  set_variance(state, filter::kVelocity, 3, config.moving_velocity_sigma_mps);
  set_variance(state, filter::kAngularVelocity, 3, config.angular_velocity_sigma_radps);
  return state;
}

Result<filter::GaussianState> initial_state(std::span<const ImuSample> samples, std::int64_t first_frame_ns,
                                            const SensorRig& rig, const config::TermsConfig& terms,
                                            const config::InitialisationConfig& initialisation,
                                            const config::SelfCalibrationConfig& self_calibration,
                                            const std::optional<filter::FilterState>& motion) {
  const bool inertial = terms.prior == config::Prior::imu;
  Result<filter::GaussianState> initial =
      inertial ? initialise_with_imu(samples, first_frame_ns, rig, initialisation)
               : initialise_without_imu(initialisation);
  if (!initial) return initial;
  if (rig.T_world_first_camera) initial = filter::moved(*initial, *rig.T_world_first_camera);
  for (const TimingPrior& prior : timing_priors(rig.timing, terms, initialisation, self_calibration))
    set_variance(*initial, prior.at, 1, prior.sigma_s);
  if (inertial && !rig.imu_axes_are_exact) set_imu_priors(*initial, self_calibration);
  if (motion) {
    initial->mean.velocity_world_mps = motion->velocity_world_mps;
    if (!inertial) initial->mean.angular_velocity_imu_radps = motion->angular_velocity_imu_radps;
  }
  return initial;
}

filter::GaussianState begun_again(const filter::GaussianState& reckoned) {
  filter::GaussianState state = reckoned;
  filter::FilterState& mean = state.mean;
  mean.T_world_imu_reference = mean.T_world_imu;
  mean.reference_rate.setZero();
  mean.reference_offset.setZero();
  mean.model_offset.setZero();
  mean.reference_rate_offset.setZero();
  mean.model_rate_offset.setZero();
  mean.reference_color_readout_s = 0;
  mean.model_readout = {};
  const Matrix3d R = mean.T_world_imu.rotation_matrix();
  const Matrix3d rotation_world =
      R * reckoned.covariance.block<3, 3>(filter::kRotation, filter::kRotation) * R.transpose();
  constexpr int kClones = filter::kStateSize - filter::kReferencePose;
  for (const auto& [offset, size] :
       {std::pair{0, filter::kPoseSize}, std::pair{+filter::kReferencePose, kClones}}) {
    state.covariance.middleRows(offset, size).setZero();
    state.covariance.middleCols(offset, size).setZero();
  }
  const Matrix3d by_velocity = hat(mean.velocity_world_mps);
  state.covariance.block<3, 3>(filter::kVelocity, filter::kVelocity) +=
      by_velocity * rotation_world * by_velocity.transpose();
  const Eigen::Matrix<double, 2, 3> by_gravity =
      s2_basis(mean.gravity_direction_world).transpose() * hat(mean.gravity_direction_world);
  state.covariance.block<2, 2>(filter::kGravity, filter::kGravity) +=
      by_gravity * rotation_world * by_gravity.transpose();
  return state;
}

}  // namespace fusebench::prediction
