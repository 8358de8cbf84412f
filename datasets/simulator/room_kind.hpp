// Generated scenes, and the scene of each preset.
#pragma once

#include <cstdint>
#include <string_view>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/simulator/scene/scene.hpp"

namespace fusebench::simulator {

enum class RoomKind {
  furnished,   ///< room.hpp
  storage,     ///< storage_room.hpp
  office,      ///< office.hpp
  flat,        ///< flat.hpp, also for twin_rooms
  twin_rooms,  ///< two equal rooms
  corridor,    ///< corridor.hpp
  gallery,     ///< gallery.hpp
};
[[nodiscard]] std::string_view to_string(RoomKind room);

[[nodiscard]] RoomKind room_of(motion::MotionPreset preset);

[[nodiscard]] scene::SimulatedScene make_room_of_kind(RoomKind room, std::uint64_t seed);

}  // namespace fusebench::simulator
