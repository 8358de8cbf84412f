#include "datasets/simulator/room_kind.hpp"

#include "datasets/simulator/scene/corridor.hpp"
#include "datasets/simulator/scene/flat.hpp"
#include "datasets/simulator/scene/gallery.hpp"
#include "datasets/simulator/scene/office.hpp"
#include "datasets/simulator/scene/room.hpp"
#include "datasets/simulator/scene/storage_room.hpp"

namespace fusebench::simulator {

std::string_view to_string(RoomKind room) {
  switch (room) {
    case RoomKind::furnished:
      return "furnished room";
    case RoomKind::storage:
      return "storage room";
    case RoomKind::office:
      return "office";
    case RoomKind::flat:
      return "flat";
    case RoomKind::twin_rooms:
      return "twin rooms";
    case RoomKind::corridor:
      return "corridor";
    case RoomKind::gallery:
      break;
  }
  return "gallery";
}

RoomKind room_of(motion::MotionPreset preset) {
  using motion::MotionPreset;
  switch (preset) {
    case MotionPreset::sweep:  // near surfaces with free space in front, for a sweep
      return RoomKind::storage;
    case MotionPreset::shake_revisit:
      return RoomKind::office;
    case MotionPreset::loop_flat:
      return RoomKind::flat;
    case MotionPreset::twin_rooms:
      return RoomKind::twin_rooms;
    case MotionPreset::corridor:
      return RoomKind::corridor;
    case MotionPreset::no_loop:
      return RoomKind::gallery;
    default:
      return RoomKind::furnished;
  }
}

scene::SimulatedScene make_room_of_kind(RoomKind room, std::uint64_t seed) {
  switch (room) {
    case RoomKind::storage:
      return scene::make_storage_room(seed);
    case RoomKind::office:
      return scene::make_office(seed);
    case RoomKind::flat:
      return scene::make_flat(seed);
    case RoomKind::twin_rooms:
      return scene::make_twin_rooms(seed);
    case RoomKind::corridor:
      return scene::make_corridor(seed);
    case RoomKind::gallery:
      return scene::make_gallery(seed);
    case RoomKind::furnished:
      break;
  }
  return scene::make_room(seed);
}

}  // namespace fusebench::simulator
