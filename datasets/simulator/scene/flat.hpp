// Furnished rooms next to each other along a corridor.
#pragma once

#include <cstdint>

#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator::scene {

/// Floor at z = 0. Room i and its part of the corridor are around x = i kUnit_m; rooms are at y > 0, the
/// corridor at y < 0. Each room has a door opening in the middle of its wall to the corridor, whose corridor
/// side is at y = 0.
struct FlatShape {
  static constexpr double kUnit_m = 5.25;                           ///< from one room to the next
  static constexpr double kWall_m = 0.25;                           ///< thickness
  static constexpr double kRoom_m = 5.0;                            ///< both sides of a room
  static constexpr double kRoomMiddle_m = kWall_m + 0.5 * kRoom_m;  ///< along y
  static constexpr double kCorridorWidth_m = 2.0;
  static constexpr double kHeight_m = 2.75;
  static constexpr double kDoorWidth_m = 1.25;
  static constexpr double kDoorHeight_m = 2.125;
};

inline constexpr int kFlatRooms = 3;

/// Three rooms, about 15.8 x 7.3 m, with different furniture, textures and order of walls. free_space is in
/// the middle of the first room, at the height of hand-held cameras. The same seed gives the same scene.
[[nodiscard]] SimulatedScene make_flat(std::uint64_t seed);

/// Two rooms with bit-identical shape, furniture, textures and light, and identical parts of the corridor.
/// Only the ends of the corridor differ; they are not visible from the rooms.
[[nodiscard]] SimulatedScene make_twin_rooms(std::uint64_t seed);

}  // namespace fusebench::simulator::scene
