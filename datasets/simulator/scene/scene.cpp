#include "datasets/simulator/scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::simulator::scene {

void color_vertices(SimulatedScene& scene) {
  constexpr float kFootprint_texels = 16;  // a vertex represents its surroundings
  scene.mesh.colors.resize(scene.mesh.vertices.size(), Rgb{0, 0, 0});
  for (std::size_t t = 0; t < scene.triangle_textures.size(); ++t) {
    if (scene.triangle_textures[t] == SimulatedScene::kNoTexture) continue;
    const texture::Texture& texture = scene.textures[static_cast<std::size_t>(scene.triangle_textures[t])];
    for (const std::uint32_t vertex : scene.mesh.triangles[t]) {
      const Eigen::Vector2f& at = scene.texture_coordinates[vertex];
      const Eigen::Array4f reflectance = texture.sample(at.x(), at.y(), kFootprint_texels);
      const float light = scene.light.empty() ? 1.0F : scene.light[vertex];
      for (std::size_t c = 0; c < 3; ++c) {
        const float sent = std::clamp(light * reflectance[static_cast<Eigen::Index>(c)], 0.0F, 1.0F);
        scene.mesh.colors[vertex][c] = static_cast<std::uint8_t>(
            std::lround(255.0 * texture::srgb_from_linear(static_cast<double>(sent))));
      }
    }
  }
}

}  // namespace fusebench::simulator::scene
