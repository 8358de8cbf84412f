#include "core/estimator/patches/posed_camera.hpp"

namespace fusebench::patches {

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

}  // namespace fusebench::patches
