// Small objects that occlude each other, on the boards of an open rack. Each function takes the frame of the
// object, as in room_furniture.hpp; sizes are in metres. Each object fits into the given width and height.
#pragma once

#include <cstdint>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"

namespace fusebench::simulator::scene {

class Clutter {
 public:
  /// Paints labels with patterns that depend on the key.
  Clutter(RoomBuilder& builder, const RoomTextures& textures, random::RandomSequence& random,
          std::uint64_t key);

  /// A row of objects from the wall to the front on a board of the given free size (width, depth, height),
  /// with gaps that show the wall behind.
  void fill_board(const SE3& T, const Vector3d& clear_m);

  void can(const SE3& T, double max_height_m);
  void bottle(const SE3& T, double max_height_m);
  void box(const SE3& T, double max_height_m);  ///< turned by any angle
  void leaning_books(const SE3& T, double width_m, double max_height_m);
  void plates(const SE3& T, double width_m, double max_height_m);  ///< upright in a rack, one behind another
  void pencils(const SE3& T, double max_height_m);                 ///< in a pot
  void pot_plant(const SE3& T, double max_height_m);
  void wire_basket(const SE3& T, double width_m, double depth_m, double max_height_m);
  void slatted_crate(const SE3& T, double width_m, double depth_m, double max_height_m);
  void poster(const SE3& T, double width_m, double height_m);  ///< on a wall
  /// A cable that hangs between two points, with its middle lower by the sag.
  void cable(const Vector3d& from_room, const Vector3d& to_room, double sag_m);
  /// Leaves along a stalk that hangs down from the frame's origin.
  void creeper(const SE3& T, double length_m);

 private:
  [[nodiscard]] Paint label(double repeat_m);
  void bar(const Vector3d& from_room, const Vector3d& to_room, double thickness_m, const Paint& paint);
  void leaf(const SE3& T, double length_m);
  double wide_object(const SE3& T_left, double room_m, double depth_m, double max_height_m);
  double slender_object(const SE3& T_left, double max_height_m);
  [[nodiscard]] double any(double low, double high) { return random_.uniform(low, high); }

  RoomBuilder& builder_;
  const RoomTextures& textures_;
  random::RandomSequence& random_;
  std::vector<std::int32_t> labels_;
};

}  // namespace fusebench::simulator::scene
