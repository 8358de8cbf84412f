#include "core/estimator/patches/measured_surfaces.hpp"

#include <optional>

namespace fusebench::patches {

namespace {

/// Unit normal in the camera frame, towards the camera.
std::optional<Vector3d> measured_normal(const DepthImage& depth_m, const PinholeCamera& camera, int x,
                                        int y) {
  const auto at = [&](int u, int v) -> std::optional<Vector3d> {
    if (!depth_m.contains(u, v) || !(depth_m(u, v) > 0)) return std::nullopt;
    return camera.back_project(u, v, static_cast<double>(depth_m(u, v)));
  };
  const auto left = at(x - kNormalReach_px, y);
  const auto right = at(x + kNormalReach_px, y);
  const auto up = at(x, y - kNormalReach_px);
  const auto down = at(x, y + kNormalReach_px);
  if (!left || !right || !up || !down) return std::nullopt;
  // y points down, so down x across points towards the camera.
  const Vector3d normal = (*down - *up).cross(*right - *left);
  const double length = normal.norm();
  if (!(length > 0)) return std::nullopt;
  return normal / length;
}

}  // namespace

std::vector<raycast::SurfacePoint> measured_surfaces(const DepthImage& depth_m, const PinholeCamera& camera,
                                                     const SE3& T_world_camera,
                                                     std::span<const raycast::ExpectedSurface> pixels) {
  std::vector<raycast::SurfacePoint> surfaces(pixels.size());
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto x = static_cast<int>(pixels[i].u_px);
    const auto y = static_cast<int>(pixels[i].v_px);
    const float measured_m = depth_m(x, y);
    if (!(measured_m > 0)) continue;
    surfaces[i].valid = true;
    surfaces[i].depth_m = static_cast<double>(measured_m);
    if (const auto normal = measured_normal(depth_m, camera, x, y))
      surfaces[i].normal_world = T_world_camera.rotation * *normal;
  }
  return surfaces;
}

}  // namespace fusebench::patches
