#include "eval/paper_figures/model_view.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "datasets/simulator/rays/ray_caster.hpp"

namespace fusebench::paper_figures {

namespace {

using simulator::rays::RayCaster;
using simulator::rays::RayHit;

constexpr int kMostWalls = 6;     // that are looked through along a ray
constexpr float kPast_m = 1e-3F;  // the next ray begins behind the surface

/// What a ray sees.
struct SeenSurface {
  RayHit hit;
  float cosine = 0;  ///< between the normal and the ray back
};

/// Towards the outside of the triangle, not normalised.
Eigen::Vector3f normal_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
}

std::optional<SeenSurface> first_front(const RayCaster& caster, const Mesh& mesh, Eigen::Vector3f origin,
                                       const Eigen::Vector3f& direction) {
  for (int wall = 0; wall < kMostWalls; ++wall) {
    RayHit hit;
    caster.cast(origin, {&direction.x(), 1}, {&direction.y(), 1}, {&direction.z(), 1}, {&hit, 1});
    if (hit.triangle == RayHit::kNothing) return std::nullopt;
    const Eigen::Vector3f normal = normal_of(mesh, hit.triangle);
    const float towards = -normal.dot(direction);
    if (towards > 0) return SeenSurface{hit, towards / (normal.norm() * direction.norm())};
    origin += direction * hit.distance + direction.normalized() * kPast_m;
  }
  return std::nullopt;
}

Rgb shaded(const Mesh& mesh, const SeenSurface& seen) {
  constexpr float kAmbient = 0.45F;
  constexpr Rgb kGrey{190, 190, 190};
  const float light = kAmbient + (1 - kAmbient) * seen.cosine;
  const auto& corners = mesh.triangles[seen.hit.triangle];
  const std::array<float, 3> share = {1 - seen.hit.u - seen.hit.v, seen.hit.u, seen.hit.v};
  Rgb result;
  for (std::size_t channel = 0; channel < 3; ++channel) {
    float value = 0;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Rgb& colour = mesh.colors.empty() ? kGrey : mesh.colors[corners[corner]];
      value += share[corner] * static_cast<float>(colour[channel]);
    }
    result[channel] = static_cast<std::uint8_t>(std::clamp(std::lround(value * light), 0L, 255L));
  }
  return result;
}

}  // namespace

ColorImage model_view(const Mesh& mesh, const PinholeCamera& camera, const SE3& T_mesh_camera) {
  ColorImage image(camera.width_px, camera.height_px, Rgb{255, 255, 255});
  if (mesh.triangles.empty()) return image;
  const RayCaster caster(mesh);
  const Eigen::Vector3f origin = T_mesh_camera.translation.cast<float>();
  for (int y = 0; y < camera.height_px; ++y) {
    for (int x = 0; x < camera.width_px; ++x) {
      const Vector3d ray = T_mesh_camera.rotation * camera.back_project(x, y, 1.0);
      if (const auto seen = first_front(caster, mesh, origin, ray.cast<float>()))
        image(x, y) = shaded(mesh, *seen);
    }
  }
  return image;
}

}  // namespace fusebench::paper_figures
