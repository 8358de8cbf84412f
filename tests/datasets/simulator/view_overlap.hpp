// What two views of a scene have in common.
#pragma once

#include <cmath>

#include "core/base/geometry.hpp"
#include "datasets/simulator/render/renderer.hpp"

namespace fusebench::testing {

/// Share of the pixels of view A (T_world_camera) whose surface is seen in view B as well: within its image
/// and not hidden there, by 5 % of the depth. Pixels without a surface count as not seen.
inline double share_seen_again(const simulator::render::Renderer& renderer, const PinholeCamera& camera,
                               const SE3& T_world_a, const SE3& T_world_b) {
  using simulator::render::Renderer;
  Image<Renderer::Surface> of_a;
  Image<Renderer::Surface> of_b;
  renderer.render_surfaces(camera, {{T_world_a}}, Workers(1), of_a);
  renderer.render_surfaces(camera, {{T_world_b}}, Workers(1), of_b);
  const SE3 T_b_a = T_world_b.inverse() * T_world_a;
  int seen = 0;
  for (int v = 0; v < camera.height_px; ++v) {
    for (int u = 0; u < camera.width_px; ++u) {
      const double depth_m = static_cast<double>(of_a(u, v).depth_m);
      if (depth_m <= 0) continue;
      const Vector3d in_b = T_b_a * camera.back_project(u, v, depth_m);
      if (in_b.z() <= 0) continue;
      const Vector2d pixel = camera.project(in_b);
      const long column = std::lround(pixel.x());
      const long row = std::lround(pixel.y());
      if (column < 0 || row < 0 || column >= camera.width_px || row >= camera.height_px) continue;
      const auto there_m = static_cast<double>(of_b(static_cast<int>(column), static_cast<int>(row)).depth_m);
      if (std::abs(there_m - in_b.z()) < 0.05 * in_b.z()) ++seen;
    }
  }
  return static_cast<double>(seen) / (camera.width_px * camera.height_px);
}

}  // namespace fusebench::testing
