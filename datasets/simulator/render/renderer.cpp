#include "datasets/simulator/render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.hpp"
#include "datasets/simulator/rays/ray_caster.hpp"

namespace fusebench::simulator::render {

namespace {

constexpr std::size_t kRowsPerChunk = 8;

/// A quantity that is linear on a triangle.
struct Linear {
  float at_a = 0;
  float along_u = 0;
  float along_v = 0;

  static Linear between(float a, float b, float c) { return {a, b - a, c - a}; }
  [[nodiscard]] float at(const rays::RayHit& hit) const { return at_a + hit.u * along_u + hit.v * along_v; }
};

/// Shading data of a textured triangle, in one cache line.
struct TriangleShading {
  Linear u;
  Linear v;
  Linear light;
  float texels_per_metre = 0;
  std::int32_t texture = scene::SimulatedScene::kNoTexture;
};

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

/// One row of rays in the world frame, and their hits.
struct RowOfRays {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  std::vector<rays::RayHit> hits;

  explicit RowOfRays(int width)
      : x(static_cast<std::size_t>(width)), y(x.size()), z(x.size()), hits(x.size()) {}

  /// Directions keep z = 1 in the camera, so that distances are z-depths.
  void cast(const rays::RayCaster& caster, const rays::RayField& field, int row, const SE3& T_world_camera,
            const Vector2d& offset_px) {
    field.row(row, offset_px, x, y);
    const Eigen::Matrix3f r = T_world_camera.rotation_matrix().cast<float>();
    for (std::size_t i = 0; i < x.size(); ++i) {
      const float cx = x[i];
      const float cy = y[i];
      x[i] = r(0, 0) * cx + r(0, 1) * cy + r(0, 2);
      y[i] = r(1, 0) * cx + r(1, 1) * cy + r(1, 2);
      z[i] = r(2, 0) * cx + r(2, 1) * cy + r(2, 2);
    }
    caster.cast(T_world_camera.translation.cast<float>(), x, y, z, hits);
  }
};

bool is_nearer(const rays::RayHit& a, const rays::RayHit& b) {
  return a.triangle != rays::RayHit::kNothing &&
         (b.triangle == rays::RayHit::kNothing || a.distance < b.distance);
}

/// fill(row) for all rows.
template <class Fill>
void for_rows(const Workers& workers, int height, const Fill& fill) {
  workers.for_chunks(static_cast<std::size_t>(height), kRowsPerChunk,
                     [&](std::size_t begin, std::size_t end) {
                       for (std::size_t row = begin; row < end; ++row) fill(static_cast<int>(row));
                     });
}

void check_arguments(const PinholeCamera& camera, const RowPoses& poses) {
  check(camera.width_px > 0 && camera.height_px > 0, "a rendered camera has a size");
  check(poses.T_world_camera.size() == 1 ||
            poses.T_world_camera.size() == static_cast<std::size_t>(camera.height_px),
        "one pose, or one for each row");
}

}  // namespace

struct Renderer::State {
  rays::RayCaster caster;
  std::vector<TriangleShading> shading;
  std::vector<std::array<Eigen::Vector3f, 3>> colors;  // by triangle, linear; empty if all have textures
  std::vector<texture::Texture> textures;
  std::vector<float> gloss;              // by texture; empty: all matt
  std::vector<Eigen::Vector3f> normals;  // by triangle; empty if all is matt
  std::vector<scene::Highlight> highlights;
  scene::Screens screens;

  explicit State(const scene::SimulatedScene& scene)
      : caster(scene.mesh),
        textures(scene.textures),
        gloss(scene.gloss),
        highlights(scene.highlights),
        screens(scene.screens) {
    if (!gloss.empty()) find_normals(scene.mesh);
    shading.reserve(scene.mesh.triangles.size());
    bool plain = false;
    for (std::size_t i = 0; i < scene.mesh.triangles.size(); ++i) {
      shading.push_back(shading_of(scene, i));
      plain |= shading.back().texture == scene::SimulatedScene::kNoTexture;
    }
    if (plain) copy_colors(scene.mesh);
  }

  /// Radiance of a hit; footprint_m: side of the square at the hit, across the ray, that is averaged.
  /// page: what screens show.
  [[nodiscard]] Eigen::Vector3f light_of(const rays::RayHit& hit, float footprint_m,
                                         std::int32_t page) const {
    const TriangleShading& at = shading[hit.triangle];
    const Eigen::Vector3f reflectance = reflectance_of(hit, footprint_m, page);
    return at.texture == scene::SimulatedScene::kNoTexture ? reflectance : at.light.at(hit) * reflectance;
  }

  [[nodiscard]] std::int32_t page_at(double time_s) const {
    if (screens.pages <= 1) return 0;
    const auto period = static_cast<std::uint64_t>(time_s / kPage_s);
    return static_cast<std::int32_t>(period % static_cast<std::uint64_t>(screens.pages));
  }

  /// What a glossy surface adds to its own light: the lamps' images, 10 degrees wide, and a faint room that
  /// is brighter above. Not shadowed. ray: from the origin, z-depth as length.
  [[nodiscard]] float mirrored_light(const rays::RayHit& hit, const Eigen::Vector3f& origin,
                                     const Eigen::Vector3f& ray) const {
    constexpr float kRoom = 0.03F;
    const float shine = gloss_of(hit);
    if (shine <= 0) return 0;
    const Eigen::Vector3f& normal = normals[hit.triangle];
    const Eigen::Vector3f direction = ray.normalized();
    const Eigen::Vector3f mirrored = direction - 2 * direction.dot(normal) * normal;
    const Eigen::Vector3f point = origin + hit.distance * ray;
    float light = kRoom * (0.5F + 0.5F * mirrored.z());
    for (const scene::Highlight& lamp : highlights) {
      float lobe = std::max(0.0F, mirrored.dot((lamp.position - point).normalized()));
      for (int i = 0; i < 6; ++i) lobe *= lobe;  // to the power of 64
      light += lamp.strength * lobe;
    }
    return shine * light;
  }

  [[nodiscard]] float gloss_of(const rays::RayHit& hit) const {
    const std::int32_t texture = shading[hit.triangle].texture;
    const bool known = texture >= 0 && static_cast<std::size_t>(texture) < gloss.size();
    return known ? gloss[static_cast<std::size_t>(texture)] : 0.0F;
  }

  /// Of the texture; the colour itself where there is none.
  [[nodiscard]] Eigen::Vector3f reflectance_of(const rays::RayHit& hit, float footprint_m,
                                               std::int32_t page = 0) const {
    const TriangleShading& at = shading[hit.triangle];
    if (at.texture == scene::SimulatedScene::kNoTexture) {
      const std::array<Eigen::Vector3f, 3>& c = colors[hit.triangle];
      return c[0] + hit.u * (c[1] - c[0]) + hit.v * (c[2] - c[0]);
    }
    // Seen obliquely the square becomes a rectangle; the side of a square of the same area avoids most of the
    // aliasing without blurring along the short side too much.
    constexpr float kMinCosine = 0.05F;
    const float texels =
        footprint_m * at.texels_per_metre / std::sqrt(std::max(kMinCosine, hit.cos_incidence));
    const Eigen::Array4f reflectance =
        textures[static_cast<std::size_t>(at.texture + (at.texture == screens.first_texture ? page : 0))]
            .sample(at.u.at(hit), at.v.at(hit), texels);
    return reflectance.head<3>().matrix();
  }

 private:
  void find_normals(const Mesh& mesh) {
    for (const auto& t : mesh.triangles) {
      const Eigen::Vector3f a = mesh.vertices[t[0]];
      const Eigen::Vector3f normal = (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
      const float length = normal.norm();
      normals.push_back(length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f::UnitZ());
    }
  }

  static TriangleShading shading_of(const scene::SimulatedScene& scene, std::size_t i) {
    TriangleShading result;
    if (scene.triangle_textures.empty() || scene.triangle_textures[i] == scene::SimulatedScene::kNoTexture)
      return result;
    const std::array<std::uint32_t, 3>& t = scene.mesh.triangles[i];
    const auto& st = scene.texture_coordinates;
    result.texture = scene.triangle_textures[i];
    result.u = Linear::between(st[t[0]].x(), st[t[1]].x(), st[t[2]].x());
    result.v = Linear::between(st[t[0]].y(), st[t[1]].y(), st[t[2]].y());
    result.light = scene.light.empty()
                       ? Linear{1, 0, 0}
                       : Linear::between(scene.light[t[0]], scene.light[t[1]], scene.light[t[2]]);
    result.texels_per_metre =
        texel_density(scene, t, scene.textures[static_cast<std::size_t>(result.texture)].side());
    return result;
  }

  void copy_colors(const Mesh& mesh) {
    const auto linear = [&](std::uint32_t vertex) -> Eigen::Vector3f {
      if (mesh.colors.empty()) return Eigen::Vector3f::Constant(0.5F);
      Eigen::Vector3f light;
      for (int c = 0; c < 3; ++c) {
        light[c] = static_cast<float>(
            texture::linear_from_srgb(mesh.colors[vertex][static_cast<std::size_t>(c)] / 255.0));
      }
      return light;
    };
    for (const auto& t : mesh.triangles) colors.push_back({linear(t[0]), linear(t[1]), linear(t[2])});
  }
};

Renderer::Renderer(const scene::SimulatedScene& scene) : state_(std::make_unique<State>(scene)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::add_light_of_row(const rays::RayField& rays, int row, const SE3& T_world_camera,
                                const Vector2d& offset_px, float footprint_px, float weight,
                                std::span<Eigen::Vector3f> light, const Foreground* foreground,
                                double time_s) const {
  RowOfRays line(rays.camera().width_px);
  line.cast(state_->caster, rays, row, T_world_camera, offset_px);
  RowOfRays before(foreground != nullptr ? rays.camera().width_px : 0);
  if (foreground != nullptr)
    before.cast(foreground->thing.state_->caster, rays, row, foreground->T_object_camera, offset_px);
  const float footprint = footprint_px / static_cast<float>(rays.camera().fx_px);
  const std::int32_t shown = state_->page_at(time_s);
  const Eigen::Vector3f origin = T_world_camera.translation.cast<float>();
  for (std::size_t i = 0; i < light.size(); ++i) {
    const bool hidden = foreground != nullptr && is_nearer(before.hits[i], line.hits[i]);
    const rays::RayHit& hit = hidden ? before.hits[i] : line.hits[i];
    const State& seen = hidden ? *foreground->thing.state_ : *state_;
    if (hit.triangle == rays::RayHit::kNothing) continue;
    const std::int32_t page = hidden ? 0 : shown;
    light[i] += weight * seen.light_of(hit, footprint * hit.distance, page);
    if (hidden || state_->normals.empty()) continue;
    const Eigen::Vector3f ray(line.x[i], line.y[i], line.z[i]);
    light[i].array() += weight * state_->mirrored_light(hit, origin, ray);
  }
}

void Renderer::render_light(const PinholeCamera& camera, const RowPoses& poses, const Vector2d& offset_px,
                            const Workers& workers, Image<Eigen::Vector3f>& light) const {
  check_arguments(camera, poses);
  const rays::RayField rays(camera);
  light = Image<Eigen::Vector3f>(camera.width_px, camera.height_px, Eigen::Vector3f::Zero());
  for_rows(workers, camera.height_px, [&](int row) {
    const std::span<Eigen::Vector3f> pixels(&light(0, row), static_cast<std::size_t>(light.width));
    add_light_of_row(rays, row, poses.of_row(row), offset_px, 1.0F, 1.0F, pixels);
  });
}

void Renderer::render_surfaces(const PinholeCamera& camera, const RowPoses& poses, const Workers& workers,
                               Image<Surface>& surfaces, bool material) const {
  check_arguments(camera, poses);
  const rays::RayField rays(camera);
  surfaces = Image<Surface>(camera.width_px, camera.height_px);
  for_rows(workers, camera.height_px, [&](int row) {
    RowOfRays line(camera.width_px);
    line.cast(state_->caster, rays, row, poses.of_row(row), Vector2d::Zero());
    for (int u = 0; u < camera.width_px; ++u) {
      const rays::RayHit& hit = line.hits[static_cast<std::size_t>(u)];
      if (hit.triangle == rays::RayHit::kNothing) continue;
      surfaces(u, row) = {hit.distance, hit.cos_incidence, hit.triangle};
      if (!material) continue;
      const float footprint_m = hit.distance / static_cast<float>(camera.fx_px);
      surfaces(u, row).reflectance = state_->reflectance_of(hit, footprint_m).sum() / 3;
      surfaces(u, row).gloss = state_->gloss_of(hit);
    }
  });
}

}  // namespace fusebench::simulator::render
