#include "core/depth_gates.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench {

DepthImage gate_depth(const DepthImage& depth_m, const DepthConfig& config) {
  DepthImage gated(depth_m.width, depth_m.height, 0.0F);
  const auto near = static_cast<float>(config.min_m);
  const auto far = static_cast<float>(config.max_m);
  const auto jump = static_cast<float>(config.edge_jump);
  for (int y = 1; y + 1 < depth_m.height; ++y) {
    for (int x = 1; x + 1 < depth_m.width; ++x) {
      const float z = depth_m(x, y);
      if (!(z >= near && z <= far)) continue;
      bool edge = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const float neighbour = depth_m(x + dx, y + dy);
          edge = edge || (neighbour > 0 && std::abs(neighbour - z) > jump * z);
        }
      }
      if (!edge) gated(x, y) = z;
    }
  }
  return gated;
}

bool is_one_surface(const DepthImage& depth_m, int x, int y, int reach_px, double edge_jump) {
  const float middle_m = depth_m(x, y);
  if (middle_m <= 0) return false;
  if (reach_px == 0) return true;
  for (int dy = -reach_px; dy <= reach_px; dy += reach_px) {
    for (int dx = -reach_px; dx <= reach_px; dx += reach_px) {
      if (!depth_m.contains(x + dx, y + dy)) continue;
      const float m = depth_m(x + dx, y + dy);
      if (m <= 0 || std::abs(m - middle_m) > edge_jump * middle_m) return false;
    }
  }
  return true;
}

Vector3d measured_normal(const DepthImage& depth_m, const PinholeCamera& camera, int x, int y) {
  constexpr int kReach = 4;
  if (!depth_m.contains(x - kReach, y - kReach) || !depth_m.contains(x + kReach, y + kReach)) {
    return Vector3d::Zero();
  }
  const auto point = [&](int dx, int dy) -> Vector3d {
    return camera.back_project(x + dx, y + dy, depth_m(x + dx, y + dy));
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

}  // namespace fusebench
