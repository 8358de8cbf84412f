#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::filter {

FilterState plus(const FilterState& state, const StateVector& delta) {
  FilterState result = state;
  result.T_world_imu = pose_plus(state.T_world_imu, delta.head<kPoseSize>());
  result.velocity_world_mps += delta.segment<3>(kVelocity);
  result.gyroscope_bias_radps += delta.segment<3>(kGyroscopeBias);
  result.accelerometer_bias_mps2 += delta.segment<3>(kAccelerometerBias);
  result.gravity_direction_world = s2_plus(state.gravity_direction_world, delta.segment<2>(kGravity));
  result.angular_velocity_imu_radps += delta.segment<3>(kAngularVelocity);
  result.imu_time_offset_s += delta[kImuTimeOffset];
  SensorErrors& sensors = result.sensors;
  sensors.imu_rotation_rad += delta.segment<3>(kImuRotation);
  sensors.gyroscope_scale += delta.segment<3>(kGyroscopeScale);
  sensors.accelerometer_scale += delta.segment<3>(kAccelerometerScale);
  sensors.color_readout_s += delta[kColorReadout];
  sensors.depth_readout_s += delta[kDepthReadout];
  sensors.depth_delay_s += delta[kDepthDelay];
  result.reference_offset += delta.segment<kPoseSize>(kReferencePose);
  result.model_offset += delta.segment<kPoseSize>(kModelPose);
  result.reference_rate_offset += delta.segment<kPoseSize>(kReferenceRate);
  result.model_rate_offset += delta.segment<kPoseSize>(kModelRate);
  return result;
}

StateVector minus(const FilterState& to, const FilterState& from) {
  StateVector delta;
  delta.head<kPoseSize>() = pose_minus(to.T_world_imu, from.T_world_imu);
  delta.segment<3>(kVelocity) = to.velocity_world_mps - from.velocity_world_mps;
  delta.segment<3>(kGyroscopeBias) = to.gyroscope_bias_radps - from.gyroscope_bias_radps;
  delta.segment<3>(kAccelerometerBias) = to.accelerometer_bias_mps2 - from.accelerometer_bias_mps2;
  delta.segment<2>(kGravity) = s2_minus(to.gravity_direction_world, from.gravity_direction_world);
  delta.segment<3>(kAngularVelocity) = to.angular_velocity_imu_radps - from.angular_velocity_imu_radps;
  delta[kImuTimeOffset] = to.imu_time_offset_s - from.imu_time_offset_s;
  const SensorErrors& a = from.sensors;
  const SensorErrors& b = to.sensors;
  delta.segment<3>(kImuRotation) = b.imu_rotation_rad - a.imu_rotation_rad;
  delta.segment<3>(kGyroscopeScale) = b.gyroscope_scale - a.gyroscope_scale;
  delta.segment<3>(kAccelerometerScale) = b.accelerometer_scale - a.accelerometer_scale;
  delta[kColorReadout] = b.color_readout_s - a.color_readout_s;
  delta[kDepthReadout] = b.depth_readout_s - a.depth_readout_s;
  delta[kDepthDelay] = b.depth_delay_s - a.depth_delay_s;
  delta.segment<kPoseSize>(kReferencePose) = to.reference_offset - from.reference_offset;
  delta.segment<kPoseSize>(kModelPose) = to.model_offset - from.model_offset;
  delta.segment<kPoseSize>(kReferenceRate) = to.reference_rate_offset - from.reference_rate_offset;
  delta.segment<kPoseSize>(kModelRate) = to.model_rate_offset - from.model_rate_offset;
  return delta;
}

Vector6d pose_rate(const FilterState& state) {
  Vector6d rate;
  rate << state.angular_velocity_imu_radps, state.velocity_world_mps;
  return rate;
}

StateMatrix chart_transport(const FilterState& state, const StateVector& delta) {
  StateMatrix transport = StateMatrix::Identity();
  transport.block<3, 3>(kRotation, kRotation) = so3_right_jacobian(delta.segment<3>(kRotation));
  // S2: Exp(B (d + e)) g = Exp(B d) Exp(Jr(B d) B e) g, so the direction at d turns about the axis Exp(B d)
  // Jr(B d) B e. The new tangent vector is this axis in the basis at the new direction (its part along the
  // direction is no motion).
  const Vector3d& from = state.gravity_direction_world;
  const Vector3d axis = s2_basis(from) * delta.segment<2>(kGravity);
  const Vector3d to = so3_exp(axis) * from;
  transport.block<2, 2>(kGravity, kGravity) =
      s2_basis(to).transpose() * so3_exp(axis).toRotationMatrix() * so3_right_jacobian(axis) * s2_basis(from);
  return transport;
}

StateMatrix symmetrised(const StateMatrix& covariance) { return 0.5 * (covariance + covariance.transpose()); }

}  // namespace fusebench::filter
