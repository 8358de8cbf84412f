// Surfaces of a room with the furniture along its walls and in its middle.
#pragma once

#include "core/base/geometry.hpp"
#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"

namespace fusebench::simulator::scene {

/// A wall with its frame: origin at its foot in the middle, x along it, y into the room, z up.
struct Wall {
  SE3 T_scene_wall;
  double length_m = 0;
  double height_m = 0;
};

/// A door opening from the floor up.
struct Opening {
  double middle_m = 0;  ///< along the wall's x
  double width_m = 0;
  double height_m = 0;
};

/// A wall of a rectangular room. T_scene_room: origin on the floor in the room's middle. half_m: half the
/// sides along x and y. index: 0 is the wall at -y, the next ones follow counter-clockwise, modulo four.
[[nodiscard]] Wall room_wall(const SE3& T_scene_room, const Vector2d& half_m, double height_m, int index);

/// Adds furniture. Random details are drawn from the given sequence in the order of the calls.
class RoomFurnishing {
 public:
  RoomFurnishing(RoomBuilder& builder, const RoomTextures& textures, Furnisher& furnisher,
                 random::RandomSequence& random)
      : builder_(builder), textures_(textures), furnisher_(furnisher), random_(random) {}

  void floor_and_ceiling(const SE3& T_scene_room, const Vector2d& half_m, double height_m);
  void seating_area(const SE3& T_scene_room);  ///< a rug and a coffee table in the middle
  void lamp_shade(const SE3& T);               ///< base at the frame's origin

  // Each function covers one wall and adds its furniture, up to 1.4 m into the room.
  void books_wall(const Wall& wall);
  void desk_wall(const Wall& wall);   ///< bricks, a pin board, a desk with a chair
  void plain_wall(const Wall& wall);  ///< paint, a door, little else
  void sofa_wall(const Wall& wall);   ///< tiles below, a window, a shelf of equal jars
  void entrance_wall(const Wall& wall, const Opening& opening);  ///< low furniture on either side of it

  /// Covers a wall from z = low to high.
  void cover(const Wall& wall, double low_m, double high_m, const Paint& paint);
  /// Covers a wall except the opening, with a continuous pattern.
  void cover_around(const Wall& wall, const Opening& opening, const Paint& paint);
  void skirting(const Wall& wall);
  /// Posts and a lintel around an opening through a wall of the given thickness, at y < 0.
  void door_frame(const Wall& wall, const Opening& opening, double thickness_m);

 private:
  RoomBuilder& builder_;
  const RoomTextures& textures_;
  Furnisher& furnisher_;
  random::RandomSequence& random_;
};

}  // namespace fusebench::simulator::scene
