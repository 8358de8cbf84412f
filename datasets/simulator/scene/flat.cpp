#include "datasets/simulator/scene/flat.hpp"

#include <numbers>
#include <utility>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furnishing.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"
#include "datasets/simulator/scene/scene_parts.hpp"

namespace fusebench::simulator::scene {

namespace {

using Shape = FlatShape;

// Largest depth of furniture from the walls, and its height in the middle of a room.
constexpr double kFurnitureReach_m = 1.4;
constexpr double kTableTop_m = 0.9;
constexpr double kAmbient = 0.5;

/// Frame of the corridor's floor in a unit: at its middle.
SE3 corridor_middle() { return placed({}, {0, -0.5 * Shape::kCorridorWidth_m, 0}); }

/// One room with its part of the corridor, around x = 0.
class UnitPlan {
 public:
  explicit UnitPlan(std::uint64_t key)
      : random_(random::mix_key(key, 1)),
        textures_(paint_room_textures(builder_, random::mix_key(key, 2))),
        furnisher_(builder_, textures_, random_),
        furnishing_(builder_, textures_, furnisher_, random_) {}

  SimulatedScene build() {
    room();
    corridor();
    const double y = Shape::kRoomMiddle_m;
    const std::vector<Lamp> lamps = {{{0.9, y + 0.7, Shape::kHeight_m - 0.45}, 1.3},
                                     {{-0.8, y - 0.9, Shape::kHeight_m - 0.45}, 1.1},
                                     {{0, -0.5 * Shape::kCorridorWidth_m, Shape::kHeight_m - 0.3}, 1.0}};
    bake_light(builder_.scene(), lamps, kAmbient);
    return std::move(builder_.scene());
  }

 private:
  void room() {
    const SE3 T_unit_room = placed({}, {0, Shape::kRoomMiddle_m, 0});
    const Vector2d half_m(0.5 * Shape::kRoom_m, 0.5 * Shape::kRoom_m);
    const auto wall = [&](int index) { return room_wall(T_unit_room, half_m, Shape::kHeight_m, index); };
    furnishing_.floor_and_ceiling(T_unit_room, half_m, Shape::kHeight_m);
    furnishing_.seating_area(T_unit_room);
    for (const Vector2d& at : {Vector2d(0.9, 0.7), Vector2d(-0.8, -0.9)})
      furnishing_.lamp_shade(placed(T_unit_room, {at.x(), at.y(), Shape::kHeight_m - 0.3}));
    furnishing_.entrance_wall(wall(0), kDoor);
    furnishing_.door_frame(wall(0), kDoor, Shape::kWall_m);
    // Threshold, which covers the gap between the two floors.
    builder_.add_box(placed({}, {0, 0.5 * Shape::kWall_m, -0.02}),
                     {Shape::kDoorWidth_m, Shape::kWall_m, 0.03},
                     {.texture = textures_.stone, .repeat_m = 0.4});
    const int turn = random_.below(3);
    furnishing_.books_wall(wall(1 + turn));
    furnishing_.desk_wall(wall(1 + (turn + 1) % 3));
    furnishing_.sofa_wall(wall(1 + (turn + 2) % 3));
  }

  void corridor() {
    const Vector2d half_m(0.5 * Shape::kUnit_m, 0.5 * Shape::kCorridorWidth_m);
    const auto wall = [&](int index) {
      return room_wall(corridor_middle(), half_m, Shape::kHeight_m, index);
    };
    furnishing_.floor_and_ceiling(corridor_middle(), half_m, Shape::kHeight_m);
    furnishing_.lamp_shade(placed({}, {0, -0.5 * Shape::kCorridorWidth_m, Shape::kHeight_m - 0.2}));
    const Wall opposite = wall(0);
    furnishing_.cover(opposite, 0, Shape::kHeight_m, {.texture = textures_.wallpaper, .repeat_m = 1.1});
    furnishing_.skirting(opposite);
    furnisher_.cabinet(placed(opposite.T_scene_wall, {any(-0.3, 0.3), 0.22, 0}), 1.0, any(0.7, 0.85));
    pictures(opposite, {-2.0, -1.2, any(-0.2, 0.2), 1.2, 2.0});
    const Wall beside_door = wall(2);
    furnishing_.cover_around(beside_door, kDoor, {.texture = textures_.plaster, .repeat_m = 1.1});
    pictures(beside_door, {-2.1, -1.3, 1.2, 1.9});
  }

  void pictures(const Wall& wall, std::initializer_list<double> along_m) {
    for (const double x : along_m)
      furnisher_.picture(placed(wall.T_scene_wall, {x, 0, any(1.45, 1.85)}), any(0.35, 0.65), any(0.4, 0.7));
  }

  [[nodiscard]] double any(double low, double high) { return random_.uniform(low, high); }

  static constexpr Opening kDoor{0, Shape::kDoorWidth_m, Shape::kDoorHeight_m};

  random::RandomSequence random_;
  RoomBuilder builder_;
  RoomTextures textures_;
  Furnisher furnisher_;
  RoomFurnishing furnishing_;
};

/// Both ends of the corridor of a row of units, each with a door.
SimulatedScene make_ends(int units, std::uint64_t key) {
  RoomBuilder builder;
  random::RandomSequence random(random::mix_key(key, 1));
  const RoomTextures textures = paint_room_textures(builder, random::mix_key(key, 2));
  Furnisher furnisher(builder, textures, random);
  RoomFurnishing furnishing(builder, textures, furnisher, random);
  const Vector2d half_m(0.5 * units * Shape::kUnit_m, 0.5 * Shape::kCorridorWidth_m);
  const SE3 T_middle = placed(corridor_middle(), {0.5 * (units - 1) * Shape::kUnit_m, 0, 0});
  std::vector<Lamp> lamps;
  for (const int index : {1, 3}) {
    const Wall wall = room_wall(T_middle, half_m, Shape::kHeight_m, index);
    const std::int32_t texture = index == 1 ? textures.bricks : textures.wallpaper;
    furnishing.cover(wall, 0, Shape::kHeight_m, {.texture = texture, .repeat_m = 0.9});
    furnisher.door(placed(wall.T_scene_wall, {0.3, 0, 0}));
    furnisher.picture(placed(wall.T_scene_wall, {-0.6, 0, 1.7}), 0.45, 0.6);
    lamps.push_back({wall.T_scene_wall * Vector3d(0, 0.5 * Shape::kUnit_m, Shape::kHeight_m - 0.3), 1.0});
  }
  bake_light(builder.scene(), lamps, kAmbient);
  return std::move(builder.scene());
}

Vector3d unit_shift(int index) { return {index * Shape::kUnit_m, 0, 0}; }

/// Adds the ends of the corridor and the data of the whole scene.
SimulatedScene finished(SimulatedScene scene, int units, std::uint64_t key) {
  const SimulatedScene ends = make_ends(units, key);
  const std::int32_t first_texture = add_part_textures(scene, ends);
  add_part(scene, ends, first_texture, Vector3d::Zero());
  color_vertices(scene);
  const double reach_m = 0.5 * Shape::kRoom_m - kFurnitureReach_m;
  scene.free_space = {Vector3d(-reach_m, Shape::kRoomMiddle_m - reach_m, kTableTop_m),
                      Vector3d(reach_m, Shape::kRoomMiddle_m + reach_m, 1.9)};
  scene.look_at = scene.free_space;
  return scene;
}

}  // namespace

SimulatedScene make_flat(std::uint64_t seed) {
  SimulatedScene scene;
  const std::uint64_t key = random::mix_key(seed, 21);
  for (int i = 0; i < kFlatRooms; ++i) {
    const SimulatedScene unit = UnitPlan(random::mix_key(key, static_cast<std::uint64_t>(i) + 1)).build();
    const std::int32_t first_texture = add_part_textures(scene, unit);
    add_part(scene, unit, first_texture, unit_shift(i));
  }
  return finished(std::move(scene), kFlatRooms, key);
}

SimulatedScene make_twin_rooms(std::uint64_t seed) {
  constexpr int kRooms = 2;
  SimulatedScene scene;
  const std::uint64_t key = random::mix_key(seed, 22);
  const SimulatedScene unit = UnitPlan(random::mix_key(key, 1)).build();
  const std::int32_t first_texture = add_part_textures(scene, unit);
  for (int i = 0; i < kRooms; ++i) add_part(scene, unit, first_texture, unit_shift(i));
  return finished(std::move(scene), kRooms, key);
}

}  // namespace fusebench::simulator::scene
