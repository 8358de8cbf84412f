// A camera at a pose hypothesis, and at the levels of the image pyramid.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::patches {

/// A camera at a pose hypothesis, with the products that every residual needs.
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

}  // namespace fusebench::patches
