#include "eval/report/model_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "datasets/simulator/rays/ray_caster.hpp"
#include "eval/metrics/mesh_error/mesh_metrics.hpp"

namespace fusebench::report {

namespace {

using simulator::rays::RayCaster;
using simulator::rays::RayHit;

constexpr Rgb kNoSurface{227, 232, 236};  // neither white, as many models are, nor dark on paper

/// Drops the triangles that are seen from behind.
void keep_fronts(Mesh& mesh, const Eigen::Vector3f& origin) {
  std::erase_if(mesh.triangles, [&](const auto& triangle) {
    const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
    const Eigen::Vector3f outward = (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
    return !(outward.dot(origin - a) > 0);
  });
}

Rgb shaded(const Mesh& mesh, const RayHit& hit) {
  constexpr float kAmbient = 0.45F;
  constexpr Rgb kGrey{190, 190, 190};
  const float light = kAmbient + (1 - kAmbient) * hit.cos_incidence;
  const auto& corners = mesh.triangles[hit.triangle];
  const std::array<float, 3> share = {1 - hit.u - hit.v, hit.u, hit.v};
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

Eigen::AlignedBox2d seen_box(std::span<const Vector3d> points, const SE3& T_points_camera,
                             double stray_share) {
  const SE3 T_camera_points = T_points_camera.inverse();
  std::array<std::vector<double>, 2> seen;
  for (const Vector3d& point : points) {
    const Vector3d p = T_camera_points * point;
    if (p.z() <= 0) continue;
    seen[0].push_back(p.x() / p.z());
    seen[1].push_back(p.y() / p.z());
  }
  Eigen::AlignedBox2d box(Vector2d(-1, -1), Vector2d(1, 1));
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double>& places = seen[static_cast<std::size_t>(axis)];
    if (places.empty()) continue;
    std::ranges::sort(places);
    box.min()[axis] = mesh_error::percentile(places, stray_share);
    box.max()[axis] = mesh_error::percentile(places, 1 - stray_share);
  }
  return box;
}

PinholeCamera camera_around(const Eigen::AlignedBox2d& box, int width_px, int height_px) {
  constexpr double kFill = 0.94;
  const Vector2d sizes = box.sizes().cwiseMax(1e-3);
  const double focal_px = kFill * std::min(width_px / sizes.x(), height_px / sizes.y());
  return {width_px,
          height_px,
          focal_px,
          focal_px,
          0.5 * (width_px - 1) - focal_px * box.center().x(),
          0.5 * (height_px - 1) - focal_px * box.center().y()};
}

ColorImage model_view(Mesh mesh, const PinholeCamera& camera, const SE3& T_mesh_camera) {
  ColorImage image(camera.width_px, camera.height_px, kNoSurface);
  const Eigen::Vector3f origin = T_mesh_camera.translation.cast<float>();
  keep_fronts(mesh, origin);
  if (mesh.triangles.empty()) return image;
  const RayCaster caster(mesh);
  const auto width = static_cast<std::size_t>(camera.width_px);
  std::array<std::vector<float>, 3> rays;
  for (std::vector<float>& axis : rays) axis.resize(width);
  std::vector<RayHit> hits(width);
  for (int y = 0; y < camera.height_px; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      const Vector3d ray = T_mesh_camera.rotation * camera.back_project(static_cast<double>(x), y, 1.0);
      for (std::size_t axis = 0; axis < 3; ++axis)
        rays[axis][x] = static_cast<float>(ray[static_cast<Eigen::Index>(axis)]);
    }
    caster.cast(origin, rays[0], rays[1], rays[2], hits);
    for (std::size_t x = 0; x < width; ++x) {
      if (hits[x].triangle != RayHit::kNothing) image(static_cast<int>(x), y) = shaded(mesh, hits[x]);
    }
  }
  return image;
}

}  // namespace fusebench::report
