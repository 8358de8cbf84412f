// The camera's velocity, from what a report says of the IMU.
#pragma once

#include "core/estimator/health/frame_report.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"

namespace fusebench::testing {

inline preprocessing::CameraVelocity camera_velocity(const health::FrameReport& report,
                                                     const SE3& T_imu_camera) {
  const Matrix3d R_camera_imu = T_imu_camera.rotation_matrix().transpose();
  const Matrix3d R_camera_world = report.T_world_camera.rotation_matrix().transpose();
  const Vector3d& rate_imu = report.angular_velocity_radps;
  return {R_camera_imu * rate_imu, R_camera_world * report.velocity_world_mps +
                                       R_camera_imu * rate_imu.cross(T_imu_camera.translation)};
}

}  // namespace fusebench::testing
