// A camera at a pose hypothesis and at the pyramid levels.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::patches {

/// A camera at a pose hypothesis with precomputed products for the residuals.
struct PosedCamera {
  PosedCamera(const PinholeCamera& camera_in, const SE3& T_world_imu, const SE3& T_imu_camera);

  PinholeCamera camera;
  Matrix3d R_camera_world;
  Vector3d t_camera_world_m;
  Matrix3d R_camera_imu;
  Matrix3d R_imu_camera;
  Vector3d t_imu_camera_m;
  Matrix3d R_world_imu;
  Vector3d t_world_imu_m;

  [[nodiscard]] Vector3d to_camera(const Vector3d& point_world) const {
    return R_camera_world * point_world + t_camera_world_m;
  }
  [[nodiscard]] Vector3d to_imu(const Vector3d& point_camera) const {
    return R_imu_camera * point_camera + t_imu_camera_m;
  }

  /// Chain rule from the derivative by the point in the camera frame to that by the pose (rotation of the IMU
  /// on the right, its position in the world): X_c = R_ci (R_wi^T (P - p_wi) - p_ic), and a rotation phi of
  /// the IMU moves X_c by R_ci [X_i]x phi.
  template <int Rows>
  [[nodiscard]] Eigen::Matrix<double, Rows, 6> by_pose(const Eigen::Matrix<double, Rows, 3>& by_point,
                                                       const Vector3d& point_camera) const {
    Eigen::Matrix<double, Rows, 6> jacobian;
    jacobian.template leftCols<3>() = by_point * R_camera_imu * hat(to_imu(point_camera));
    jacobian.template rightCols<3>() = -by_point * R_camera_world;
    return jacobian;
  }
};

/// The camera of a pyramid level: pixel (x, y) of level l is at (x, y) * 2^l of level 0.
[[nodiscard]] PinholeCamera camera_at_level(const PinholeCamera& camera, int level);

}  // namespace fusebench::patches
