// A scene of textured triangles, as the simulator renders it.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/types.hpp"
#include "datasets/simulator/texture/texture.hpp"

namespace fusebench::simulator::scene {

/// A lamp as glossy surfaces mirror it.
struct Highlight {
  Eigen::Vector3f position;
  float strength = 0;  ///< light in the middle of its image on a polished surface
};

/// A texture that stands for several in turn, as a screen shows pages.
struct Screens {
  std::int32_t first_texture = -1;  ///< where triangles have this one, `pages` textures from it on are shown
  int pages = 1;
};

/// How long a screen shows a page.
inline constexpr double kPage_s = 0.8;

/// Triangles with materials in the scene's own world: metres, z up. Surfaces are matt unless they have gloss:
/// their radiance does not depend on the direction, so a point keeps its brightness while the camera moves
/// (the sensor changes it, the scene does not).
struct SimulatedScene {
  static constexpr std::int32_t kNoTexture = -1;

  Mesh mesh;  ///< vertices, triangles; colors (sRGB, lighting included) are shown where a triangle has no
              ///< texture
  std::vector<std::int32_t>
      triangle_textures;  ///< by triangle: index into textures, or kNoTexture; empty: none
  std::vector<Eigen::Vector2f>
      texture_coordinates;  ///< by vertex, in repeats of the texture; empty without textures
  std::vector<float>
      light;  ///< by vertex: a texture's reflectance times this is what the surface sends; empty: 1
  std::vector<texture::Texture> textures;
  std::vector<float> gloss;  ///< by texture: 0 matt to 1 polished; empty: all matt
  std::vector<Highlight> highlights;
  Screens screens;

  /// Where a camera may be: nothing of the scene is inside. For scenes read from files this is an estimate
  /// (read_scene()).
  Eigen::AlignedBox3d free_space;
  /// Where the things worth looking at are.
  Eigen::AlignedBox3d look_at;
  /// Level direction from the free space to what the scene is about (about z, 0 looks along x); empty: all
  /// around.
  std::optional<double> heading_rad;
  /// The mean direction to look in where it is not the only one; empty: by the texture.
  std::optional<double> face_rad;
};

/// Gives the vertices of textured triangles the colour that they show (mesh.colors), for viewers of the mesh
/// without its textures.
void color_vertices(SimulatedScene& scene);

}  // namespace fusebench::simulator::scene
