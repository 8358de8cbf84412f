#include "core/estimator/prediction/motion_prior.hpp"

#include <cmath>

#include "core/config/groups/prediction_config.hpp"
#include "core/config/groups/terms_config.hpp"
#include "core/estimator/prediction/timing_prior.hpp"

namespace fusebench::prediction {

namespace {
double square(double x) { return x * x; }

/// Adds the variance of a random walk of the given density to the diagonal of a block.
void add_random_walk(filter::StateMatrix& noise, int offset, int size, double density, double duration_s) {
  noise.diagonal().segment(offset, size).array() += square(density) * duration_s;
}

/// Effect of a velocity on a pose over a duration.
struct VelocityEffect {
  double kept = 1;     ///< factor on the velocity
  double reach_s = 0;  ///< pose change = reach_s * velocity
  /// Variance of the pose, covariance of pose and velocity, variance of the velocity, per axis.
  Vector3d noise = Vector3d::Zero();
};

/// A constant velocity with white acceleration, integrated twice (pose) and once (velocity).
VelocityEffect constant_velocity(double dt, double acceleration_density) {
  const Vector3d white(dt * dt * dt / 3, dt * dt / 2, dt);
  return {1, dt, square(acceleration_density) * white};
}

/// An Ornstein-Uhlenbeck process.
VelocityEffect damped_velocity(double duration_s, double time_constant_s, double variance) {
  const double duration = duration_s / time_constant_s;
  const double kept = std::exp(-duration);
  const double reach_s = -time_constant_s * std::expm1(-duration);
  const Vector3d unit(square(time_constant_s) * (2 * duration - 3 + 4 * kept - square(kept)),
                      square(reach_s) / time_constant_s, 1 - square(kept));
  return {kept, reach_s, variance * unit};
}

/// Adds the noise (pose, pose-velocity, velocity), equal on all axes, to the covariance.
void add_motion_noise(filter::StateMatrix& covariance, int pose, int rate, const Vector3d& noise) {
  covariance.block<3, 3>(pose, pose).diagonal().array() += noise[0];
  covariance.block<3, 3>(pose, rate).diagonal().array() += noise[1];
  covariance.block<3, 3>(rate, pose).diagonal().array() += noise[1];
  covariance.block<3, 3>(rate, rate).diagonal().array() += noise[2];
}

/// Moves the pose by the linear (world) and the angular velocity (body).
Prediction moved_by_velocities(const filter::GaussianState& state, const VelocityEffect& linear,
                               const VelocityEffect& angular) {
  const filter::FilterState& x = state.mean;
  const Vector3d turn = angular.reach_s * x.angular_velocity_imu_radps;

  Prediction result;
  filter::FilterState& y = result.state.mean;
  y = x;
  y.T_world_imu.rotation = (x.T_world_imu.rotation * so3_exp(turn)).normalized();
  y.T_world_imu.translation += linear.reach_s * x.velocity_world_mps;
  y.velocity_world_mps *= linear.kept;
  y.angular_velocity_imu_radps *= angular.kept;

  filter::StateMatrix& F = result.transition;
  F.block<3, 3>(filter::kRotation, filter::kRotation) = so3_exp(turn).toRotationMatrix().transpose();
  F.block<3, 3>(filter::kRotation, filter::kAngularVelocity) = angular.reach_s * so3_right_jacobian(turn);
  F.block<3, 3>(filter::kPosition, filter::kVelocity) = linear.reach_s * Matrix3d::Identity();
  F.block<3, 3>(filter::kVelocity, filter::kVelocity) *= linear.kept;
  F.block<3, 3>(filter::kAngularVelocity, filter::kAngularVelocity) *= angular.kept;

  filter::StateMatrix Q = filter::StateMatrix::Zero();
  add_motion_noise(Q, filter::kRotation, filter::kAngularVelocity, angular.noise);
  add_motion_noise(Q, filter::kPosition, filter::kVelocity, linear.noise);
  result.state.covariance = filter::symmetrised(F * state.covariance * F.transpose() + Q);
  return result;
}
}  // namespace

InertialErrors inertial_errors(const filter::FilterState& state) {
  return {state.gyroscope_bias_radps, state.accelerometer_bias_mps2, state.sensors.imu_rotation_rad,
          state.sensors.gyroscope_scale, state.sensors.accelerometer_scale};
}

Prediction predict_by_imu(const filter::GaussianState& state, const PreintegratedImu& imu,
                          const ImuNoise& noise, const config::MotionConfig& config) {
  const filter::FilterState& x = state.mean;
  const double dt = imu.duration_s;
  const Matrix3d R = x.T_world_imu.rotation_matrix();
  const Vector3d gravity = kGravity_mps2 * x.gravity_direction_world;

  Prediction result;
  filter::FilterState& y = result.state.mean;
  y = x;
  y.T_world_imu.rotation = (x.T_world_imu.rotation * imu.delta_rotation).normalized();
  y.T_world_imu.translation += dt * x.velocity_world_mps + 0.5 * dt * dt * gravity + R * imu.delta_position_m;
  y.velocity_world_mps += dt * gravity + R * imu.delta_velocity_mps;
  y.angular_velocity_imu_radps = imu.angular_velocity_end_radps;
  y.angular_velocity_noise_radps = noise.gyroscope_radps_sqrthz / std::sqrt(imu.rate_averaged_s);

  filter::StateMatrix& F = result.transition;
  const Eigen::Matrix<double, 3, 2> gravity_by_delta =
      -kGravity_mps2 * hat(x.gravity_direction_world) * s2_basis(x.gravity_direction_world);
  F.block<3, 3>(filter::kRotation, filter::kRotation) = imu.delta_rotation.toRotationMatrix().transpose();
  F.block<3, 3>(filter::kVelocity, filter::kRotation) = -R * hat(imu.delta_velocity_mps);
  F.block<3, 2>(filter::kVelocity, filter::kGravity) = dt * gravity_by_delta;
  F.block<3, 3>(filter::kPosition, filter::kRotation) = -R * hat(imu.delta_position_m);
  F.block<3, 3>(filter::kPosition, filter::kVelocity) = dt * Matrix3d::Identity();
  F.block<3, 2>(filter::kPosition, filter::kGravity) = 0.5 * dt * dt * gravity_by_delta;
  // The body rate is measured again, so its previous error is replaced by that of the IMU.
  F.block<3, 3>(filter::kAngularVelocity, filter::kAngularVelocity).setZero();
  const auto by_errors = [&F](int row, const ByInertialErrors& jacobian) {
    F.block<3, 6>(row, filter::kGyroscopeBias) = jacobian.leftCols<6>();
    F.block<3, 9>(row, filter::kImuRotation) = jacobian.rightCols<9>();
  };
  by_errors(filter::kRotation, imu.rotation_by_errors);
  by_errors(filter::kVelocity, R * imu.velocity_by_errors);
  by_errors(filter::kPosition, R * imu.position_by_errors);
  by_errors(filter::kAngularVelocity, imu.angular_velocity_end_by_errors);
  F.block<3, 1>(filter::kRotation, filter::kImuTimeOffset) = imu.rotation_by_time_offset;
  F.block<3, 1>(filter::kVelocity, filter::kImuTimeOffset) = R * imu.velocity_by_time_offset;
  F.block<3, 1>(filter::kPosition, filter::kImuTimeOffset) = R * imu.position_by_time_offset;
  F.block<3, 1>(filter::kAngularVelocity, filter::kImuTimeOffset) = imu.angular_acceleration_end_radps2;

  // Increments are in the previous IMU frame; velocity and position errors are in the world.
  Eigen::Matrix<double, filter::kStateSize, 9> G = Eigen::Matrix<double, filter::kStateSize, 9>::Zero();
  G.block<3, 3>(filter::kRotation, 0).setIdentity();
  G.block<3, 3>(filter::kVelocity, 3) = R;
  G.block<3, 3>(filter::kPosition, 6) = R;
  const double factor = square(config.imu_noise_factor);
  filter::StateMatrix Q = factor * (G * imu.covariance * G.transpose());
  add_random_walk(Q, filter::kGyroscopeBias, 3, config.imu_noise_factor * noise.gyroscope_bias_radps2_sqrthz,
                  dt);
  add_random_walk(Q, filter::kAccelerometerBias, 3,
                  config.imu_noise_factor * noise.accelerometer_bias_mps3_sqrthz, dt);
  add_random_walk(Q, filter::kGravity, 2, config.gravity_noise_rad_sqrthz, dt);
  Q.diagonal().segment<3>(filter::kAngularVelocity).array() +=
      square(config.imu_noise_factor * y.angular_velocity_noise_radps);

  result.state.covariance = filter::symmetrised(F * state.covariance * F.transpose() + Q);
  return result;
}

Prediction predict_by_constant_velocity(const filter::GaussianState& state, double duration_s,
                                        const config::MotionConfig& config) {
  return moved_by_velocities(state, constant_velocity(duration_s, config.acceleration_noise_mps2_sqrthz),
                             constant_velocity(duration_s, config.angular_acceleration_noise_radps2_sqrthz));
}

MotionScale initial_motion_scale(const config::MotionConfig& config) {
  return {square(config.speed_mps), square(config.rate_radps)};
}

MotionScale followed_scale(const MotionScale& scale, const filter::FilterState& state, double duration_s,
                           const config::MotionConfig& config) {
  const double weight = 1 - std::exp(-duration_s / config.scale_time_s);
  const double speed_m2ps2 = state.velocity_world_mps.squaredNorm() / 3;
  const double rate_rad2ps2 = state.angular_velocity_imu_radps.squaredNorm() / 3;
  return {scale.speed_m2ps2 + weight * (speed_m2ps2 - scale.speed_m2ps2),
          scale.rate_rad2ps2 + weight * (rate_rad2ps2 - scale.rate_rad2ps2)};
}

Prediction predict_by_motion_model(const filter::GaussianState& state, double duration_s,
                                   const MotionScale& scale, const config::MotionConfig& config) {
  return moved_by_velocities(state, damped_velocity(duration_s, config.speed_time_s, scale.speed_m2ps2),
                             damped_velocity(duration_s, config.rate_time_s, scale.rate_rad2ps2));
}

Result<filter::GaussianState> predict_by_samples(const filter::GaussianState& state,
                                                 const FrameInterval& interval,
                                                 std::span<const ImuSample> samples, const SensorRig& rig,
                                                 const config::TermsConfig& terms,
                                                 const config::MotionConfig& motion,
                                                 const config::InitialisationConfig& initialisation,
                                                 const config::SelfCalibrationConfig& self_calibration) {
  const filter::FilterState& x = state.mean;
  const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * x.imu_time_offset_s));
  const Result<PreintegratedImu> increments =  // Eqs. 11-13
      preintegrate(samples, interval.begin_ns + offset_ns, interval.end_ns + offset_ns, inertial_errors(x),
                   rig.imu_noise);
  if (!increments) return tl::unexpected(increments.error());
  filter::GaussianState predicted =
      predict_by_imu(state, *increments, rig.imu_noise, motion).state;  // Eqs. 8-10, 14
  add_timing_walk(predicted.covariance, rig.timing, seconds_between(interval.begin_ns, interval.end_ns),
                  terms, initialisation, self_calibration);
  return predicted;
}

}  // namespace fusebench::prediction
