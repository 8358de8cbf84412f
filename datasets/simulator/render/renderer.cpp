#include "datasets/simulator/render/renderer.hpp"

#include <bit>
#include <utility>

#include "core/base/error.hpp"
#include "datasets/simulator/render/lit_scene.hpp"
#include "datasets/simulator/render/row_light.hpp"

namespace fusebench::simulator::render {

using simd::Float8;
using simd::Int8;
using simd::kLanes;

namespace {

void check_arguments(const PinholeCamera& camera, const RowPoses& poses) {
  check(camera.width_px > 0 && camera.height_px > 0, "a rendered camera has a size");
  check(poses.T_world_camera.size() == 1 ||
            poses.T_world_camera.size() == static_cast<std::size_t>(camera.height_px),
        "one pose, or one for each row");
}

}  // namespace

Renderer::Renderer(const scene::SimulatedScene& scene) : scene_(std::make_unique<LitScene>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::add_light_of_row(const rays::RayField& rays, std::span<const RowSample> samples,
                                std::span<Eigen::Array4f> light) const {
  add_light_of_samples(*scene_, rays, samples, light);
}

void Renderer::render_light(const PinholeCamera& camera, const RowPoses& poses, const Vector2d& offset_px,
                            const Workers& workers, Image<Eigen::Vector3f>& light) const {
  check_arguments(camera, poses);
  const rays::RayField rays(camera);
  light = Image<Eigen::Vector3f>(camera.width_px, camera.height_px, Eigen::Vector3f::Zero());
  workers.for_rows(camera.height_px, [&](int row) {
    std::vector<Eigen::Array4f> pixels(static_cast<std::size_t>(camera.width_px), Eigen::Array4f::Zero());
    const RowSample sample{.row = row, .T_world_camera = poses.of_row(row), .offset_px = offset_px};
    add_light_of_row(rays, {&sample, 1}, pixels);
    for (int u = 0; u < camera.width_px; ++u)
      light(u, row) = pixels[static_cast<std::size_t>(u)].head<3>().matrix();
  });
}

VisibleTriangles Renderer::visible_triangles(const rays::RayField& rays, RowPoses poses,
                                             const Workers& workers) const {
  const PinholeCamera& camera = rays.camera();
  check_arguments(camera, poses);
  VisibleTriangles visible;
  visible.poses = std::move(poses);
  visible.triangle = Image<std::int32_t>(camera.width_px, camera.height_px);
  visible.inverse_depth_per_m = Image<float>(camera.width_px, camera.height_px);
  workers.for_rows(camera.height_px, [&](int row) {
    const std::vector<PacketHits> hits = scene_->trace(rays_of_row(rays, row, visible.poses.of_row(row)));
    for (int u = 0; u < camera.width_px; ++u) {
      const PacketHits& packet = hits[static_cast<std::size_t>(u) / kLanes];
      const std::size_t lane = static_cast<std::size_t>(u) % kLanes;
      visible.triangle(u, row) = packet.triangle[lane];
      visible.inverse_depth_per_m(u, row) = packet.triangle[lane] < 0 ? 0.0F : 1.0F / packet.distance[lane];
    }
  });
  mark_edges(scene_->planes.faces(), visible);
  return visible;
}

void Renderer::render_surfaces(const PinholeCamera& camera, const RowPoses& poses, const Workers& workers,
                               Image<Surface>& surfaces, bool material) const {
  check_arguments(camera, poses);
  const rays::RayField rays(camera);
  surfaces = Image<Surface>(camera.width_px, camera.height_px);
  const Float8 footprint = simd::all_lanes(1.0F / static_cast<float>(camera.fx_px));
  workers.for_rows(camera.height_px, [&](int row) {
    const std::vector<PacketHits> hits = scene_->trace(rays_of_row(rays, row, poses.of_row(row)));
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const std::size_t begin = i * kLanes;
      const PacketHits& packet = hits[i];
      const unsigned seen = simd::lane_bits(packet.triangle >= 0) &
                            first_lanes(static_cast<std::size_t>(camera.width_px) - begin);
      texture::Texture::Samples reflectance;
      if (material) reflectance = scene_->shading.light_of(packet, seen, footprint, Int8{}, false);
      for (unsigned left = seen; left != 0; left &= left - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(left));
        Surface& surface = surfaces(static_cast<int>(begin + lane), row);
        const std::int32_t triangle = packet.triangle[lane];
        surface = {packet.distance[lane], packet.cos_incidence[lane], static_cast<std::uint32_t>(triangle)};
        if (!material) continue;
        surface.reflectance = reflectance[lane].head<3>().sum() / 3;
        surface.gloss = scene_->shading.gloss_of(triangle);
      }
    }
  });
}

}  // namespace fusebench::simulator::render
