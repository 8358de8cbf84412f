// The normal of a measured surface at one pixel: what the association of eight
// (core/estimator/measurement/patch_sums.hpp) is held against.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::testing {

/// Unit normal, camera frame, towards the camera; zero where a neighbour is missing. Central differences over
/// +-4 pixels, since neighbouring pixels of structured-light depth share their disparity step.
inline Vector3d measured_normal(const DepthImage& depth_m, const PinholeCamera& camera, int x, int y) {
  constexpr int kReach = 4;
  if (!depth_m.contains(x - kReach, y - kReach) || !depth_m.contains(x + kReach, y + kReach)) {
    return Vector3d::Zero();
  }
  const auto point = [&](int dx, int dy) -> Vector3d {
    return camera.back_project(x + dx, y + dy, static_cast<double>(depth_m(x + dx, y + dy)));
  };
  const Vector3d left = point(-kReach, 0);
  const Vector3d right = point(kReach, 0);
  const Vector3d up = point(0, -kReach);
  const Vector3d down = point(0, kReach);
  if (left.z() <= 0 || right.z() <= 0 || up.z() <= 0 || down.z() <= 0) return Vector3d::Zero();
  // y points down, so (down - up) x (right - left) looks back at the camera.
  const Vector3d normal = (down - up).cross(right - left);
  const double length = normal.norm();
  return length > 0 ? Vector3d(normal / length) : Vector3d::Zero();
}

}  // namespace fusebench::testing
