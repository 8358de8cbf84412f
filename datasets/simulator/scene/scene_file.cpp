#include "datasets/simulator/scene/scene_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/mesh/mesh_file.hpp"
#include "datasets/simulator/texture/texture_patterns.hpp"

namespace fusebench::simulator::scene {

namespace {

namespace fs = std::filesystem;

constexpr float kFarthest_m = 1e6F;  // a float resolves 6 cm there, without overflow of products
constexpr float kTextureRepeat_m = 1.2F;
constexpr int kTextureSide = 512;

/// A mesh without shared vertices, textured and lit by the direction of each face.
SimulatedScene textured(const Mesh& mesh) {
  SimulatedScene scene;
  scene.textures.emplace_back(texture::paint_speckles(kTextureSide, texture::reflectance_of(0xc0b8a8),
                                                      texture::reflectance_of(0x4a4038), 1));
  for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[triangle[0]];
    const Eigen::Vector3f normal =
        (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a).stableNormalized();
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    const auto first = static_cast<std::uint32_t>(scene.mesh.vertices.size());
    for (const std::uint32_t vertex : triangle) {
      const Eigen::Vector3f& point = mesh.vertices[vertex];
      scene.mesh.vertices.push_back(point);
      scene.mesh.normals.push_back(normal);
      scene.texture_coordinates.emplace_back(Eigen::Vector2f(point[(axis + 1) % 3], point[(axis + 2) % 3]) /
                                             kTextureRepeat_m);
      scene.light.push_back(0.75F + 0.2F * normal.z() + 0.1F * normal.x() + 0.05F * normal.y());
    }
    scene.mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.triangle_textures.assign(scene.mesh.triangles.size(), 0);
  color_vertices(scene);
  return scene;
}

}  // namespace

Result<SimulatedScene> read_scene(const fs::path& file, const SceneFileOptions& options) {
  if (!(options.metres_per_unit >= 1e-6 && options.metres_per_unit <= 1e6)) {
    return fail(ErrorCode::configuration,
                fmt::format("metres_per_unit = {} (allowed 1e-6 .. 1e6)", options.metres_per_unit));
  }
  const Result<PreciseMesh> precise = mesh::read_mesh(file);
  if (!precise) return tl::unexpected(precise.error());
  Mesh mesh = precise->cast<float>();
  if (mesh.triangles.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{}: no triangles, so nothing is visible", file.string()),
                "a point cloud has to be meshed first");
  }
  Eigen::AlignedBox3d bounds;
  for (Eigen::Vector3f& vertex : mesh.vertices) {
    vertex *= static_cast<float>(options.metres_per_unit);
    if (!(vertex.array().abs() <= kFarthest_m).all()) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: a vertex at {}, {}, {} m (allowed -1e6 .. 1e6; metres_per_unit = {})",
                              file.string(), vertex.x(), vertex.y(), vertex.z(), options.metres_per_unit),
                  "a scene must be near the origin; check its unit");
    }
    if (options.y_up) vertex = Eigen::Vector3f(vertex.x(), -vertex.z(), vertex.y());
    bounds.extend(vertex.cast<double>());
  }
  mesh.normals.clear();  // normals of the file are unused and may be wrong
  SimulatedScene scene;
  if (mesh.colors.empty()) {
    scene = textured(mesh);
  } else {
    scene.mesh = std::move(mesh);
  }
  constexpr double kInner = 0.1;  // of the extent, to both sides of the centre
  scene.free_space = {bounds.center() - kInner * bounds.sizes(), bounds.center() + kInner * bounds.sizes()};
  scene.look_at = bounds;
  return scene;
}

}  // namespace fusebench::simulator::scene
