// Adds triangles with texture coordinates to a scene: rectangles, boxes, round bodies.
#pragma once

#include <cstdint>

#include "core/base/geometry.hpp"
#include "datasets/simulator/scene/scene.hpp"
#include "datasets/simulator/texture/texture_patterns.hpp"

namespace fusebench::simulator::scene {

/// Texture of a surface.
struct Paint {
  std::int32_t texture = 0;  ///< index into the scene's textures
  double repeat_m = 0.64;    ///< side of one repeat; 0: the texture covers a rectangle (or a mantle) once
  Vector2d offset{0, 0};     ///< shift, in repeats
  float brightness = 1;      ///< factor on the reflectance
};

/// Divides large surfaces into cells, over which light can vary. Normals point outwards.
class RoomBuilder {
 public:
  std::int32_t add_texture(const texture::ReflectanceImage& image);

  /// Rectangle from `corner` along two edges; its front is towards `along` x `up`.
  void add_rectangle(const Vector3d& corner, const Vector3d& along, const Vector3d& up, const Paint& paint);
  /// Box centred on the frame's origin in x and y, with its bottom at z = 0; `top` is for the upper face.
  void add_box(const SE3& T_room_box, const Vector3d& size, const Paint& sides, const Paint& top);
  void add_box(const SE3& T_room_box, const Vector3d& size, const Paint& paint) {
    add_box(T_room_box, size, paint, paint);
  }
  /// Round body about the frame's z axis from z = 0, radius_bottom to radius_top, closed at both ends.
  void add_frustum(const SE3& T_room_base, double radius_bottom, double radius_top, double height,
                   const Paint& paint);
  void add_cylinder(const SE3& T_room_base, double radius, double height, const Paint& paint) {
    add_frustum(T_room_base, radius, radius, height, paint);
  }
  /// Ellipsoid centred at the frame's origin.
  void add_ellipsoid(const SE3& T_room_centre, const Vector3d& radii, const Paint& paint);

  /// The current scene; light is the brightness of the paint.
  [[nodiscard]] SimulatedScene& scene() { return scene_; }

 private:
  std::uint32_t add_vertex(const Vector3d& point, const Vector3d& normal, const Vector2d& texture,
                           float light);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::int32_t texture);
  void add_cap(const SE3& T_room_base, double z, double radius, double sign, const Paint& paint);

  SimulatedScene scene_;
};

}  // namespace fusebench::simulator::scene
