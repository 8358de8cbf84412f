// Scene data of a renderer: triangle search, hits on given triangles, light.
#pragma once

#include <bit>
#include <cstring>
#include <vector>

#include "datasets/simulator/rays/ray_caster.hpp"
#include "datasets/simulator/render/ray_list.hpp"
#include "datasets/simulator/render/surface_shading.hpp"
#include "datasets/simulator/render/triangle_planes.hpp"

namespace fusebench::simulator::render {

/// Geometry and its emitted light.
struct LitScene {
  rays::RayCaster caster;
  TrianglePlanes planes;
  SurfaceShading shading;

  explicit LitScene(const scene::SimulatedScene& scene)
      : caster(scene.mesh), planes(scene.mesh, scene.triangle_textures), shading(scene) {}

  /// Intersections of rays with given triangles (-1: nothing).
  [[nodiscard]] PacketHits meet(simd::Int8 triangles, const RayPacket& rays) const {
    PacketHits hits;
    for_each_value(triangles, simd::lane_bits(triangles >= 0), [&](std::int32_t triangle, simd::Int8 same) {
      const PacketHits on_plane = planes.meet(triangle, rays);
      hits.take(same & (on_plane.distance > 0.0F), on_plane);
    });
    hits.u = simd::clamp(hits.u, 0, 1);
    hits.v = simd::min(simd::clamp(hits.v, 0, 1), 1.0F - hits.u);
    return hits;
  }

  /// Nearest hits by packet.
  [[nodiscard]] std::vector<PacketHits> trace(const RayList& rays) const {
    std::vector<std::uint32_t> triangles(rays.size());
    caster.nearest_triangles(rays.rays(), triangles);
    std::vector<PacketHits> hits;
    hits.reserve(rays.size() / simd::kLanes);
    for (std::size_t i = 0; i < rays.size(); i += simd::kLanes) {
      simd::Int8 packet;
      std::memcpy(&packet, &triangles[i], sizeof(packet));  // kNothing is -1
      hits.push_back(meet(packet, rays.packet(i)));
    }
    return hits;
  }

  /// Light of hits in the given lanes; see SurfaceShading::light_of().
  [[nodiscard]] texture::Texture::Samples light_of(const PacketHits& hits, const RayPacket& rays,
                                                   unsigned lanes, simd::Float8 footprint,
                                                   simd::Int8 page) const {
    texture::Texture::Samples light = shading.light_of(hits, lanes, footprint, page);
    if (!shading.has_gloss()) return light;
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
      const std::int32_t triangle = hits.triangle[lane];
      const float gloss = shading.gloss_of(triangle);
      if (gloss <= 0) continue;
      const Eigen::Vector3f ray = rays.direction(lane);
      const Eigen::Vector3f point = rays.origin(lane) + hits.distance[lane] * ray;
      const Eigen::Vector3f& normal = planes.normal(static_cast<std::size_t>(triangle));
      light[lane] += shading.mirrored_light(gloss, normal, point, ray);
    }
    return light;
  }
};

}  // namespace fusebench::simulator::render
