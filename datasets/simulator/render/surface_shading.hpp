// Light that triangles emit towards a camera.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "datasets/simulator/render/triangle_planes.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::render {

/// Textures, light and gloss of the triangles of a scene.
class SurfaceShading {
 public:
  explicit SurfaceShading(const scene::SimulatedScene& scene);

  /// Reflectance of hits in the given lanes, times light if `lit`; mesh colours (already lit) without a
  /// texture. footprint: side of the square that a ray covers at distance 1, across the ray. page: content of
  /// screens.
  [[nodiscard]] texture::Texture::Samples light_of(const PacketHits& hits, unsigned lanes,
                                                   simd::Float8 footprint, simd::Int8 page,
                                                   bool lit = true) const;

  /// Page of the screens at a time.
  [[nodiscard]] std::int32_t page_at(double time_s) const;

  [[nodiscard]] bool has_gloss() const { return !gloss_.empty(); }
  /// 0 (matt) to 1 (polished).
  [[nodiscard]] float gloss_of(std::int32_t triangle) const;

  /// Light that a glossy surface adds: images of the lamps, 10 degrees wide, and a faint room that is
  /// brighter above. Without shadows. ray: from the origin to the point, of any length.
  [[nodiscard]] float mirrored_light(float gloss, const Eigen::Vector3f& normal, const Eigen::Vector3f& point,
                                     const Eigen::Vector3f& ray) const;

 private:
  /// A linear quantity on a triangle.
  struct Linear {
    float at_a = 0;
    float along_u = 0;
    float along_v = 0;

    static Linear between(float a, float b, float c) { return {a, b - a, c - a}; }
    [[nodiscard]] simd::Float8 at(const PacketHits& hits) const {
      return simd::multiply_add(along_v, hits.v, simd::multiply_add(along_u, hits.u, simd::all_lanes(at_a)));
    }
  };
  /// Data of a textured triangle in one cache line.
  struct TriangleShading {
    Linear u;
    Linear v;
    Linear light;
    float texels_per_metre = 0;
    std::int32_t texture = scene::SimulatedScene::kNoTexture;
  };
  [[nodiscard]] Eigen::Array4f color_of(const PacketHits& hits, std::size_t lane) const;
  static TriangleShading shading_of(const scene::SimulatedScene& scene, std::size_t triangle);
  void copy_colors(const Mesh& mesh);

  std::vector<TriangleShading> triangles_;
  std::vector<std::array<Eigen::Vector3f, 3>> colors_;  // by triangle, linear; empty if all have textures
  std::vector<texture::Texture> textures_;
  std::vector<float> gloss_;  // by texture; empty: all matt
  std::vector<scene::Highlight> highlights_;
  scene::Screens screens_;
};

}  // namespace fusebench::simulator::render
