// Overlap of two views of a scene.
#pragma once

#include <cmath>

#include "core/base/geometry.hpp"
#include "datasets/simulator/render/renderer.hpp"

namespace fusebench::testing {

/// Surface points in the view from a pose. Computed once for all comparisons.
struct SeenView {
  SeenView(const simulator::render::Renderer& renderer, const PinholeCamera& seen_by,
           const SE3& T_world_seen_by)
      : camera(seen_by), T_world_camera(T_world_seen_by) {
    renderer.render_surfaces(camera, {{T_world_camera}}, Workers(1), surfaces);
  }

  PinholeCamera camera;
  SE3 T_world_camera;
  Image<simulator::render::Renderer::Surface> surfaces;
};

/// Share of the pixels of view A whose surface is seen in view B as well: within its image and not hidden
/// there, by 5 % of the depth. Pixels without a surface count as not seen.
inline double share_seen_again(const SeenView& a, const SeenView& b) {
  const PinholeCamera& camera = b.camera;
  const SE3 T_b_a = b.T_world_camera.inverse() * a.T_world_camera;
  int seen = 0;
  for (int v = 0; v < a.camera.height_px; ++v) {
    for (int u = 0; u < a.camera.width_px; ++u) {
      const double depth_m = static_cast<double>(a.surfaces(u, v).depth_m);
      if (depth_m <= 0) continue;
      const Vector3d in_b = T_b_a * a.camera.back_project(u, v, depth_m);
      if (in_b.z() <= 0) continue;
      const Vector2d pixel = camera.project(in_b);
      const long column = std::lround(pixel.x());
      const long row = std::lround(pixel.y());
      if (column < 0 || row < 0 || column >= camera.width_px || row >= camera.height_px) continue;
      const auto there_m =
          static_cast<double>(b.surfaces(static_cast<int>(column), static_cast<int>(row)).depth_m);
      if (std::abs(there_m - in_b.z()) < 0.05 * in_b.z()) ++seen;
    }
  }
  return static_cast<double>(seen) / (a.camera.width_px * a.camera.height_px);
}

}  // namespace fusebench::testing
