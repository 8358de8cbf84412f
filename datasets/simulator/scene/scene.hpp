// A scene of textured triangles for the simulator.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "datasets/simulator/texture/texture.hpp"

namespace fusebench::simulator::scene {

/// Reflection of a lamp on glossy surfaces.
struct Highlight {
  Eigen::Vector3f position;
  float strength = 0;  ///< light in the centre of its reflection on a polished surface
};

/// A texture that is replaced by several in turn, as the pages of a screen.
struct Screens {
  std::int32_t first_texture = -1;  ///< triangles with this texture show `pages` textures in turn, from it on
  int pages = 1;
};

/// Display time of a page.
inline constexpr double kPage_s = 0.8;

/// Triangles with materials in the scene's world: metres, z up. Surfaces without gloss are matt: their
/// radiance does not depend on the direction, so a point keeps its brightness while the camera moves. The
/// sensor model changes the brightness.
struct SimulatedScene {
  static constexpr std::int32_t kNoTexture = -1;

  Mesh mesh;  ///< vertices, triangles; colors (sRGB, with lighting) apply to triangles without a texture
  std::vector<std::int32_t>
      triangle_textures;  ///< by triangle: index into textures, or kNoTexture; empty: none
  std::vector<Eigen::Vector2f>
      texture_coordinates;   ///< by vertex, in repeats of the texture; empty without textures
  std::vector<float> light;  ///< by vertex: emitted light = reflectance * light; empty: 1
  std::vector<texture::Texture> textures;
  std::vector<float> gloss;  ///< by texture: 0 matt to 1 polished; empty: all matt
  std::vector<Highlight> highlights;
  Screens screens;

  /// Free space for cameras. For scenes from files it is an estimate (read_scene()).
  Eigen::AlignedBox3d free_space;
  /// Region with the objects of interest.
  Eigen::AlignedBox3d look_at;
  /// Horizontal direction from the free space to the objects (about z, 0 is along x); empty: all around.
  std::optional<double> heading_rad;
  /// Mean viewing direction, if there is a preferred one; empty: by the texture.
  std::optional<double> face_rad;
};

/// Sets mesh.colors of vertices of textured triangles to their displayed colour, for viewers without
/// textures.
void color_vertices(SimulatedScene& scene);

}  // namespace fusebench::simulator::scene
