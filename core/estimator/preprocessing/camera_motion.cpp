#include "core/estimator/preprocessing/camera_motion.hpp"

namespace fusebench::preprocessing {

CameraVelocity camera_velocity(const filter::FilterState& state, const SE3& T_imu_camera) {
  const Matrix3d R_camera_imu = T_imu_camera.rotation_matrix().transpose();
  const Vector3d& rate_imu = state.angular_velocity_imu_radps;
  const Vector3d velocity_imu = state.T_world_imu.rotation.conjugate() * state.velocity_world_mps +
                                rate_imu.cross(T_imu_camera.translation);
  return {R_camera_imu * rate_imu, R_camera_imu * velocity_imu};
}

FrameTiming estimated_timing(const RgbdFrame& frame, const SensorTiming& timing,
                             const filter::SensorErrors& errors) {
  FrameTiming result = frame_timing(frame, timing);
  result.color_readout_s += errors.color_readout_s;
  result.depth_readout_s += errors.depth_readout_s;
  result.depth_delay_s += errors.depth_delay_s;
  return result;
}

double predicted_blur_px(const filter::FilterState& state, const SensorRig& rig, double exposure_s) {
  return rig.camera.fx_px * camera_velocity(state, rig.T_imu_camera).angular_radps.head<2>().norm() *
         exposure_s;
}

bool velocity_changed_much(const filter::FilterState& before, const filter::FilterState& now,
                           const VelocityTolerance& tolerance) {
  const double turn_radps = (now.angular_velocity_imu_radps - before.angular_velocity_imu_radps).norm();
  const double move_mps = (now.velocity_world_mps - before.velocity_world_mps).norm();
  return turn_radps > tolerance.angular_radps || move_mps > tolerance.linear_mps;
}

}  // namespace fusebench::preprocessing
