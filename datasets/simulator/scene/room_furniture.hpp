// Furniture from rectangles, boxes and round bodies. Each function takes the frame of the object: origin at
// the middle of its base (on the floor, on furniture or at the wall), z up, y from its back to its front.
#pragma once

#include <array>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"

namespace fusebench::simulator::scene {

/// The textures of one room.
struct RoomTextures {
  std::int32_t plain = 0;
  std::int32_t plaster = 0;
  std::int32_t wallpaper = 0;
  std::int32_t bricks = 0;
  std::int32_t floor = 0;
  std::int32_t ceiling = 0;
  std::int32_t rug = 0;
  std::int32_t light_wood = 0;
  std::int32_t dark_wood = 0;
  std::int32_t tiles = 0;
  std::int32_t stone = 0;
  std::int32_t metal = 0;
  std::int32_t leaf = 0;
  std::int32_t outdoors = 0;
  std::array<std::int32_t, 3> fabrics{};
  std::array<std::int32_t, 2> spines{};
  std::array<std::int32_t, 2> pages{};
  std::array<std::int32_t, 5> pictures{};
};

/// Paints all textures; colours and patterns depend on the key.
[[nodiscard]] RoomTextures paint_room_textures(RoomBuilder& builder, std::uint64_t key);

/// A frame with a translation and a rotation about z relative to another one.
[[nodiscard]] SE3 placed(const SE3& T_room_base, const Vector3d& at, double yaw_rad = 0);

/// Builds furniture with random details.
class Furnisher {
 public:
  Furnisher(RoomBuilder& builder, const RoomTextures& textures, random::RandomSequence& random)
      : builder_(builder), textures_(textures), random_(random) {}

  // Large pieces (room_furniture.cpp).
  void bookshelf(const SE3& T, double width_m, double height_m);
  void desk(const SE3& T);
  void chair(const SE3& T);
  void sofa(const SE3& T);
  void coffee_table(const SE3& T);
  void cabinet(const SE3& T, double width_m, double height_m);
  void shelf_of_jars(const SE3& T, int columns, int rows);  ///< all alike, on a wall

  // Small objects and wall decoration (room_objects.cpp).
  void books(const SE3& T, double width_m, double max_height_m);  ///< a standing row, spines towards y
  void stack_of_books(const SE3& T, int count);
  void papers(const SE3& T, double reach_m, int count);  ///< scattered sheets
  void carton(const SE3& T, const Vector3d& size);
  void mug(const SE3& T);
  void vase(const SE3& T);
  void plant(const SE3& T, double height_m);
  void table_lamp(const SE3& T, double height_m);
  void monitor(const SE3& T);
  void picture(const SE3& T, double width_m, double height_m);  ///< on a wall
  void door(const SE3& T);
  void window(const SE3& T);
  void small_object(const SE3& T);  ///< one of the above, up to 0.3 m high and 0.24 m wide

 private:
  [[nodiscard]] Paint wood(bool dark) const;
  [[nodiscard]] Paint cover();  ///< of a book or a box
  void legs(const SE3& T, double width_m, double depth_m, double height_m, const Paint& paint);
  [[nodiscard]] double any(double low, double high) { return random_.uniform(low, high); }

  RoomBuilder& builder_;
  const RoomTextures& textures_;
  random::RandomSequence& random_;
};

}  // namespace fusebench::simulator::scene
