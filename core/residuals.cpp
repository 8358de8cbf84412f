#include "core/residuals.hpp"

#include <cmath>

namespace fusebench {

PosedCamera::PosedCamera(const PinholeCamera& camera_in, const SE3& T_world_imu, const SE3& T_imu_camera)
    : camera(camera_in),
      R_imu_camera(T_imu_camera.rotation_matrix()),
      t_imu_camera_m(T_imu_camera.translation),
      R_world_imu(T_world_imu.rotation_matrix()),
      t_world_imu_m(T_world_imu.translation) {
  R_camera_imu = R_imu_camera.transpose();
  R_camera_world = R_camera_imu * R_world_imu.transpose();
  t_camera_world_m = -R_camera_world * (R_world_imu * t_imu_camera_m + t_world_imu_m);
}

PinholeCamera camera_at_level(const PinholeCamera& camera, int level) {
  PinholeCamera scaled = camera;
  for (int l = 0; l < level; ++l) {
    scaled.width_px = (scaled.width_px + 1) / 2;
    scaled.height_px = (scaled.height_px + 1) / 2;
  }
  const double scale = 1.0 / static_cast<double>(1 << level);
  scaled.fx_px *= scale;
  scaled.fy_px *= scale;
  scaled.cx_px *= scale;
  scaled.cy_px *= scale;
  return scaled;
}

Projection project_with_jacobian(const PosedCamera& posed, const Vector3d& point_camera) {
  // X_c = R_ci (R_wi^T (P - p_wi) - p_ic): turning the IMU by phi moves X_c by R_ci [X_i]x phi.
  Projection projection;
  projection.pixel_px = posed.camera.project(point_camera);
  const Matrix2x3d by_point = posed.camera.projection_jacobian(point_camera);
  projection.jacobian.leftCols<3>() = by_point * posed.R_camera_imu * hat(posed.to_imu(point_camera));
  projection.jacobian.rightCols<3>() = -by_point * posed.R_camera_world;
  return projection;
}

PhotometricResidual photometric_residual(const IntensitySample& observed,
                                         const Eigen::Matrix<double, 2, 6>& pixel_jacobian,
                                         double reference_grey, double gain, double offset_grey) {
  PhotometricResidual residual;
  residual.value_grey = observed.value - (gain * reference_grey + offset_grey);
  residual.jacobian = observed.dx * pixel_jacobian.row(0) + observed.dy * pixel_jacobian.row(1);
  return residual;
}

PlaneResidual point_to_plane_residual(const PosedCamera& posed, const Vector3d& point_imu,
                                      const Vector3d& plane_point_world, const Vector3d& normal_world) {
  PlaneResidual residual;
  const Vector3d point_world = posed.R_world_imu * point_imu + posed.t_world_imu_m;
  residual.value_m = normal_world.dot(point_world - plane_point_world);
  residual.jacobian.leftCols<3>() = point_imu.cross(posed.R_world_imu.transpose() * normal_world).transpose();
  residual.jacobian.rightCols<3>() = normal_world.transpose();
  return residual;
}

RobustValue huber(double whitened, double k) {
  const double magnitude = std::abs(whitened);
  if (magnitude <= k) return {0.5 * whitened * whitened, 1.0};
  return {k * (magnitude - 0.5 * k), k / magnitude};
}

}  // namespace fusebench
