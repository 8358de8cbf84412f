// The residuals of the update, their Jacobians and the robust kernel for one pixel in double precision: what
// the sums over eight pixels at a time (core/estimator/measurement/patch_sums.hpp) are held against.
#pragma once

#include <cmath>

#include "core/base/geometry.hpp"
#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::testing {

using RowVector6d = Eigen::Matrix<double, 1, 6>;

/// Where a point lands, and how that moves with the pose (2x6, pixels of the camera's level).
struct Projection {
  Vector2d pixel_px = Vector2d::Zero();
  Eigen::Matrix<double, 2, 6> jacobian;
};
inline Projection project_with_jacobian(const patches::PosedCamera& posed, const Vector3d& point_camera) {
  Projection projection;
  projection.pixel_px = posed.camera.project(point_camera);
  projection.jacobian = posed.by_pose(posed.camera.projection_jacobian(point_camera), point_camera);
  return projection;
}

/// Eq. 3 per pixel: r = I_k(u) - (gain * reference + offset), grey levels, with dr/dpose.
struct PhotometricResidual {
  double value_grey = 0;
  RowVector6d jacobian = RowVector6d::Zero();
};
inline PhotometricResidual photometric_residual(const IntensitySample& observed,
                                                const Eigen::Matrix<double, 2, 6>& pixel_jacobian,
                                                double reference_grey, double gain, double offset_grey) {
  PhotometricResidual residual;
  residual.value_grey = observed.value - (gain * reference_grey + offset_grey);
  residual.jacobian = observed.dx * pixel_jacobian.row(0) + observed.dy * pixel_jacobian.row(1);
  return residual;
}

/// Eq. 4 per pixel: r = n . (T_world_imu * point_imu - plane_point), metres, with dr/dpose; the association
/// is fixed.
struct PlaneResidual {
  double value_m = 0;
  RowVector6d jacobian = RowVector6d::Zero();
};
inline PlaneResidual point_to_plane_residual(const patches::PosedCamera& posed, const Vector3d& point_imu,
                                             const Vector3d& plane_point_world,
                                             const Vector3d& normal_world) {
  PlaneResidual residual;
  const Vector3d point_world = posed.R_world_imu * point_imu + posed.t_world_imu_m;
  residual.value_m = normal_world.dot(point_world - plane_point_world);
  residual.jacobian.leftCols<3>() = point_imu.cross(posed.R_world_imu.transpose() * normal_world).transpose();
  residual.jacobian.rightCols<3>() = normal_world.transpose();
  return residual;
}

/// Huber's kernel on a whitened residual: quadratic up to k, linear beyond. cost ~ r^2 / 2 near zero.
struct RobustValue {
  double cost = 0;
  double weight = 1;  ///< of the squared residual in the normal equations
};
inline RobustValue huber(double whitened, double k) {
  const double magnitude = std::abs(whitened);
  if (magnitude <= k) return {0.5 * whitened * whitened, 1.0};
  return {k * (magnitude - 0.5 * k), k / magnitude};
}

}  // namespace fusebench::testing
