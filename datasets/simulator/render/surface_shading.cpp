#include "datasets/simulator/render/surface_shading.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::simulator::render {

namespace {

float texel_density(const scene::SimulatedScene& scene, const std::array<std::uint32_t, 3>& triangle,
                    int side) {
  const Eigen::Vector3f a = scene.mesh.vertices[triangle[0]];
  const Eigen::Vector3f ab = scene.mesh.vertices[triangle[1]] - a;
  const Eigen::Vector3f ac = scene.mesh.vertices[triangle[2]] - a;
  const Eigen::Vector2f s = scene.texture_coordinates[triangle[1]] - scene.texture_coordinates[triangle[0]];
  const Eigen::Vector2f t = scene.texture_coordinates[triangle[2]] - scene.texture_coordinates[triangle[0]];
  const float area = ab.cross(ac).norm();
  const float texture_area = std::abs(s.x() * t.y() - s.y() * t.x());
  return area > 0 ? static_cast<float>(side) * std::sqrt(texture_area / area) : 0.0F;
}

}  // namespace

SurfaceShading::SurfaceShading(const scene::SimulatedScene& scene)
    : textures_(scene.textures), gloss_(scene.gloss), highlights_(scene.highlights), screens_(scene.screens) {
  triangles_.reserve(scene.mesh.triangles.size());
  bool plain = false;
  for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
    triangles_.push_back(shading_of(scene, i));
    plain |= triangles_.back().texture == scene::SimulatedScene::kNoTexture;
  }
  if (plain) copy_colors(scene.mesh);
}

texture::Texture::Samples SurfaceShading::light_of(const PacketHits& hits, unsigned lanes,
                                                   simd::Float8 footprint, simd::Int8 page, bool lit) const {
  simd::Int8 texture = simd::all_lanes(scene::SimulatedScene::kNoTexture);
  simd::Float8 u{}, v{}, light{}, texels_per_metre{};
  for_each_value(hits.triangle, lanes, [&](std::int32_t triangle, simd::Int8 same) {
    const TriangleShading& at = triangles_[static_cast<std::size_t>(triangle)];
    texture = same ? simd::all_lanes(at.texture) : texture;
    u = same ? at.u.at(hits) : u;
    v = same ? at.v.at(hits) : v;
    light = same ? at.light.at(hits) : light;
    texels_per_metre = same ? simd::all_lanes(at.texels_per_metre) : texels_per_metre;
  });
  // At an oblique view the square projects to a rectangle. A square of the same area avoids most of the
  // aliasing without much blur along the short side.
  constexpr float kMinCosine = 0.05F;
  const simd::Float8 stretch = simd::sqrt(simd::max(simd::all_lanes(kMinCosine), hits.cos_incidence));
  const simd::Float8 texels = footprint * hits.distance * texels_per_metre / stretch;
  if (screens_.pages > 1) texture += texture == screens_.first_texture ? page : simd::all_lanes(0);

  texture::Texture::Samples result;
  for_each_value(texture, lanes, [&](std::int32_t shown, simd::Int8 same) {
    const unsigned these = lanes & simd::lane_bits(same);
    if (shown != scene::SimulatedScene::kNoTexture)
      textures_[static_cast<std::size_t>(shown)].sample(u, v, texels, these, result);
    for (unsigned left = these; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(left));
      if (shown == scene::SimulatedScene::kNoTexture) {
        result[lane] = color_of(hits, lane);
      } else if (lit) {
        result[lane] *= light[lane];
      }
    }
  });
  return result;
}

Eigen::Array4f SurfaceShading::color_of(const PacketHits& hits, std::size_t lane) const {
  const std::array<Eigen::Vector3f, 3>& c = colors_[static_cast<std::size_t>(hits.triangle[lane])];
  const Eigen::Vector3f color = c[0] + hits.u[lane] * (c[1] - c[0]) + hits.v[lane] * (c[2] - c[0]);
  return {color.x(), color.y(), color.z(), 0.0F};
}

std::int32_t SurfaceShading::page_at(double time_s) const {
  if (screens_.pages <= 1) return 0;
  const auto period = static_cast<std::uint64_t>(time_s / scene::kPage_s);
  return static_cast<std::int32_t>(period % static_cast<std::uint64_t>(screens_.pages));
}

float SurfaceShading::gloss_of(std::int32_t triangle) const {
  const std::int32_t texture = triangles_[static_cast<std::size_t>(triangle)].texture;
  const bool known = texture >= 0 && static_cast<std::size_t>(texture) < gloss_.size();
  return known ? gloss_[static_cast<std::size_t>(texture)] : 0.0F;
}

float SurfaceShading::mirrored_light(float gloss, const Eigen::Vector3f& normal, const Eigen::Vector3f& point,
                                     const Eigen::Vector3f& ray) const {
  constexpr float kRoom = 0.03F;
  const Eigen::Vector3f direction = ray.normalized();
  const Eigen::Vector3f mirrored = direction - 2 * direction.dot(normal) * normal;
  float light = kRoom * (0.5F + 0.5F * mirrored.z());
  for (const scene::Highlight& lamp : highlights_) {
    float lobe = std::max(0.0F, mirrored.dot((lamp.position - point).normalized()));
    for (int i = 0; i < 6; ++i) lobe *= lobe;  // power of 64
    light += lamp.strength * lobe;
  }
  return gloss * light;
}

SurfaceShading::TriangleShading SurfaceShading::shading_of(const scene::SimulatedScene& scene,
                                                           std::size_t triangle) {
  TriangleShading result;
  if (scene.triangle_textures.empty() ||
      scene.triangle_textures[triangle] == scene::SimulatedScene::kNoTexture)
    return result;
  const std::array<std::uint32_t, 3>& t = scene.mesh.triangles[triangle];
  const auto& st = scene.texture_coordinates;
  result.texture = scene.triangle_textures[triangle];
  result.u = Linear::between(st[t[0]].x(), st[t[1]].x(), st[t[2]].x());
  result.v = Linear::between(st[t[0]].y(), st[t[1]].y(), st[t[2]].y());
  result.light = scene.light.empty()
                     ? Linear{1, 0, 0}
                     : Linear::between(scene.light[t[0]], scene.light[t[1]], scene.light[t[2]]);
  result.texels_per_metre =
      texel_density(scene, t, scene.textures[static_cast<std::size_t>(result.texture)].side());
  return result;
}

void SurfaceShading::copy_colors(const Mesh& mesh) {
  const auto linear = [&](std::uint32_t vertex) -> Eigen::Vector3f {
    if (mesh.colors.empty()) return Eigen::Vector3f::Constant(0.5F);
    Eigen::Vector3f light;
    for (int c = 0; c < 3; ++c) {
      light[c] = static_cast<float>(
          texture::linear_from_srgb(mesh.colors[vertex][static_cast<std::size_t>(c)] / 255.0));
    }
    return light;
  };
  for (const auto& t : mesh.triangles) colors_.push_back({linear(t[0]), linear(t[1]), linear(t[2])});
}

}  // namespace fusebench::simulator::render
