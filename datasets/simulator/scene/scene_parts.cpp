#include "datasets/simulator/scene/scene_parts.hpp"

#include <cmath>

#include "core/base/error.hpp"

namespace fusebench::simulator::scene {

std::int32_t add_part_textures(SimulatedScene& scene, const SimulatedScene& part) {
  const auto first = static_cast<std::int32_t>(scene.textures.size());
  scene.textures.insert(scene.textures.end(), part.textures.begin(), part.textures.end());
  return first;
}

void add_part(SimulatedScene& scene, const SimulatedScene& part, std::int32_t first_texture,
              const Vector3d& shift_m) {
  check(part.triangle_textures.size() == part.mesh.triangles.size(), "a part with textures");
  const auto first_vertex = static_cast<std::uint32_t>(scene.mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : part.mesh.vertices) {
    const Vector3d rounded_m = kPartGrid_m * (vertex.cast<double>() / kPartGrid_m).array().round().matrix();
    scene.mesh.vertices.push_back((rounded_m + shift_m).cast<float>());
  }
  const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
  append(scene.mesh.normals, part.mesh.normals);
  append(scene.texture_coordinates, part.texture_coordinates);
  append(scene.light, part.light);
  for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t) {
    auto triangle = part.mesh.triangles[t];
    for (std::uint32_t& vertex : triangle) vertex += first_vertex;
    scene.mesh.triangles.push_back(triangle);
    scene.triangle_textures.push_back(part.triangle_textures[t] + first_texture);
  }
}

}  // namespace fusebench::simulator::scene
