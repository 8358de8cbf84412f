// The two residuals of the update with their analytic Jacobians, and the robust kernel. Pure functions.
#pragma once

#include "core/geometry.hpp"
#include "core/image.hpp"
#include "core/types.hpp"

namespace fusebench {

using RowVector6d = Eigen::Matrix<double, 1, 6>;

/// A camera at a pose hypothesis, with the products that every residual needs. Jacobians are by the tangent
/// of T_world_imu: right rotation (rad, IMU frame), then position (m, world).
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
};

/// The camera of a pyramid level: pixel (x, y) of level l is (x, y) * 2^l of level 0.
[[nodiscard]] PinholeCamera camera_at_level(const PinholeCamera& camera, int level);

/// Where a point lands, and how that moves with the pose (2x6, pixels of the camera's level).
struct Projection {
  Vector2d pixel_px = Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> jacobian;
};
[[nodiscard]] Projection project_with_jacobian(const PosedCamera& posed, const Vector3d& point_camera);

/// Eq. 3 per pixel: r = I_k(u) - (gain * reference + offset), grey levels, with dr/dpose.
struct PhotometricResidual {
  double value_grey = 0;
  RowVector6d jacobian = RowVector6d::Zero();
};
[[nodiscard]] PhotometricResidual photometric_residual(const IntensitySample& observed,
                                                       const Eigen::Matrix<double, 2, 6>& pixel_jacobian,
                                                       double reference_grey, double gain,
                                                       double offset_grey);

/// Eq. 4 per pixel: r = n . (T_world_imu * point_imu - plane_point), metres, with dr/dpose; the association
/// is fixed.
struct PlaneResidual {
  double value_m = 0;
  RowVector6d jacobian = RowVector6d::Zero();
};
[[nodiscard]] PlaneResidual point_to_plane_residual(const PosedCamera& posed, const Vector3d& point_imu,
                                                    const Vector3d& plane_point_world,
                                                    const Vector3d& normal_world);

/// Huber's kernel on a whitened residual: quadratic up to k, linear beyond. cost ~ r^2 / 2 near zero.
struct RobustValue {
  double cost = 0;
  double weight = 1;  ///< of the squared residual in the normal equations
};
[[nodiscard]] RobustValue huber(double whitened, double k);

}  // namespace fusebench
