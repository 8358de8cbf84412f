#include "datasets/simulator/scene/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"

namespace fusebench::simulator::scene {

namespace {

// How far furniture may reach into the room from the walls, and up in its middle.
constexpr double kFurnitureReach_m = 1.4;
constexpr double kTableTop_m = 0.9;

/// A wall's frame: origin at its foot in the middle, x along it, y into the room, z up.
struct Wall {
  SE3 T_room_wall;
  double length_m = 0;
  double height_m = 0;
};

class RoomPlan {
 public:
  explicit RoomPlan(std::uint64_t seed)
      : random_(random::mix_key(seed, 1)),
        textures_(paint_room_textures(builder_, random::mix_key(seed, 2))),
        furnisher_(builder_, textures_, random_),
        half_x_m_(random_.uniform(2.4, 2.7)),
        half_y_m_(random_.uniform(2.4, 2.7)),
        height_m_(random_.uniform(2.65, 2.85)) {}

  SimulatedScene build() {
    floor_and_ceiling();
    const int first = random_.below(4);
    const int step = random_.below(2) == 0 ? 1 : 3;  // clockwise or not
    books_wall(wall(first));
    desk_wall(wall(first + step));
    plain_wall(wall(first + 2 * step));
    sofa_wall(wall(first + 3 * step));
    SimulatedScene& scene = builder_.scene();
    const std::vector<Lamp> lamps = {{{0.9, 0.7, height_m_ - 0.45}, 1.3},
                                     {{-0.8, -0.9, height_m_ - 0.45}, 1.1}};
    bake_light(scene, lamps, 0.5);
    color_vertices(scene);
    const double x = half_x_m_ - kFurnitureReach_m;
    const double y = half_y_m_ - kFurnitureReach_m;
    scene.free_space = {Vector3d(-x, -y, kTableTop_m), Vector3d(x, y, 1.9)};
    scene.look_at = {Vector3d(0.3 - half_x_m_, 0.3 - half_y_m_, 0.3),
                     Vector3d(half_x_m_ - 0.3, half_y_m_ - 0.3, 1.9)};
    return std::move(scene);
  }

 private:
  [[nodiscard]] Wall wall(int index) const {
    const bool across = index % 2 == 0;
    const Quaterniond turn = so3_exp({0, 0, (index % 4) * 0.5 * std::numbers::pi});
    return {{turn, turn * Vector3d(0, across ? -half_y_m_ : -half_x_m_, 0)},
            2 * (across ? half_x_m_ : half_y_m_),
            height_m_};
  }

  /// Covers a wall from z = low to high.
  void cover(const Wall& wall, double low_m, double high_m, const Paint& paint) {
    builder_.add_rectangle(wall.T_room_wall * Vector3d(0.5 * wall.length_m, 0, low_m),
                           wall.T_room_wall.rotation * Vector3d(-wall.length_m, 0, 0), {0, 0, high_m - low_m},
                           paint);
  }
  void skirting(const Wall& wall) {
    builder_.add_box(placed(wall.T_room_wall, {0, 0.01, 0}), {wall.length_m, 0.02, 0.09},
                     {.texture = textures_.dark_wood, .repeat_m = 0.6});
  }

  void floor_and_ceiling() {
    const Vector3d x(2 * half_x_m_, 0, 0);
    const Vector3d y(0, 2 * half_y_m_, 0);
    const Vector3d corner(-half_x_m_, -half_y_m_, 0);
    builder_.add_rectangle(corner, x, y, {.texture = textures_.floor, .repeat_m = 1.1});
    builder_.add_rectangle(corner + Vector3d(0, 0, height_m_), y, x,
                           {.texture = textures_.ceiling, .repeat_m = 1.6});
    const double turn = random_.uniform(-0.3, 0.3);
    builder_.add_box(placed({}, {0, 0, 0.001}, turn), {2.2, 1.6, 0.012},
                     {.texture = textures_.rug, .repeat_m = 0});
    furnisher_.coffee_table(
        placed({}, {random_.uniform(-0.3, 0.3), random_.uniform(-0.2, 0.2), 0.013}, turn + 0.2));
    for (const double at : {-1.2, 0.0, 1.2}) {  // beams
      builder_.add_box(placed({}, {0, at, height_m_ - 0.16}), {2 * half_x_m_, 0.14, 0.16},
                       {.texture = textures_.dark_wood, .repeat_m = 0.8, .offset = {at, at}});
    }
    for (const Vector2d& at : {Vector2d(0.9, 0.7), Vector2d(-0.8, -0.9)}) {  // shades above the lamps
      builder_.add_frustum(placed({}, {at.x(), at.y(), height_m_ - 0.3}), 0.2, 0.08, 0.14,
                           {.texture = textures_.fabrics[1], .repeat_m = 0.3, .brightness = 1.3F});
    }
  }

  void books_wall(const Wall& w) {
    cover(w, 0, w.height_m, {.texture = textures_.wallpaper, .repeat_m = 1.1});
    skirting(w);
    const double shelf_m = random_.uniform(1.5, 1.9);
    const double x = 0.5 * (w.length_m - shelf_m) - 0.25;
    furnisher_.bookshelf(placed(w.T_room_wall, {x, 0.17, 0}), shelf_m, random_.uniform(1.85, 2.15));
    furnisher_.cabinet(placed(w.T_room_wall, {x - 0.5 * shelf_m - 0.75, 0.24, 0}), 1.2, 0.8);
    furnisher_.picture(placed(w.T_room_wall, {x - 0.5 * shelf_m - 0.75, 0, 1.6}), 0.8, 0.6);
    furnisher_.picture(placed(w.T_room_wall, {0.4 - 0.5 * w.length_m, 0, 1.75}), 0.4, 0.5);
  }

  void desk_wall(const Wall& w) {
    cover(w, 0, w.height_m, {.texture = textures_.bricks, .repeat_m = 1.0});
    skirting(w);
    const double x = random_.uniform(-0.5, 0.2);
    furnisher_.desk(placed(w.T_room_wall, {x, 0.42, 0}));
    furnisher_.chair(
        placed(w.T_room_wall, {x - 0.1, 1.02, 0}, std::numbers::pi + random_.uniform(-0.3, 0.3)));
    builder_.add_box(placed(w.T_room_wall, {x, 0.015, 1.25}), {1.3, 0.03, 0.75},
                     {.texture = textures_.fabrics[0], .repeat_m = 0.4});
    for (int i = 0; i < 5; ++i) {  // sheets and pictures on the pin board
      furnisher_.picture(placed(w.T_room_wall, {x - 0.5 + 0.25 * i, 0.03, random_.uniform(1.5, 1.75)}), 0.2,
                         random_.uniform(0.22, 0.36));
    }
    for (int i = 0; i < 3; ++i) {
      furnisher_.carton(
          placed(w.T_room_wall, {0.5 * w.length_m - 0.45, 0.4, 0.3 * i}, random_.uniform(-0.2, 0.2)),
          {0.5, 0.4, 0.29});
    }
    furnisher_.picture(placed(w.T_room_wall, {0.5 * w.length_m - 0.6, 0, 1.6}), 0.6, 0.75);
  }

  void plain_wall(const Wall& w) {
    cover(w, 0, w.height_m, {.texture = textures_.plain, .repeat_m = 1});
    skirting(w);
    furnisher_.plant(placed(w.T_room_wall, {0.5 * w.length_m - 0.42, 0.42, 0}), random_.uniform(0.8, 1.2));
    furnisher_.door(placed(w.T_room_wall, {0.8 - 0.5 * w.length_m, 0, 0}));
    furnisher_.chair(placed(w.T_room_wall, {0.5 * w.length_m - 1.2, 0.45, 0}, random_.uniform(-0.4, 0.4)));
    furnisher_.picture(placed(w.T_room_wall, {0.5 * w.length_m - 0.5, 0, 1.6}), 0.5, 0.7);
  }

  void sofa_wall(const Wall& w) {
    constexpr double kWainscot_m = 1.05;
    cover(w, 0, kWainscot_m, {.texture = textures_.tiles, .repeat_m = 1.0});
    cover(w, kWainscot_m, w.height_m, {.texture = textures_.plaster, .repeat_m = 1.3});
    skirting(w);
    const double x = random_.uniform(-0.4, 0.0);
    furnisher_.sofa(placed(w.T_room_wall, {x, 0.5, 0}));
    furnisher_.window(placed(w.T_room_wall, {x, 0, 1.2}));
    furnisher_.shelf_of_jars(placed(w.T_room_wall, {0.5 * w.length_m - 0.65, 0, 1.3}), 6, 3);
    furnisher_.cabinet(placed(w.T_room_wall, {0.5 * w.length_m - 0.6, 0.24, 0}), 0.9, 0.6);
  }

  random::RandomSequence random_;
  RoomBuilder builder_;
  RoomTextures textures_;
  Furnisher furnisher_;
  double half_x_m_;
  double half_y_m_;
  double height_m_;
};

}  // namespace

SimulatedScene make_room(std::uint64_t seed) { return RoomPlan(seed).build(); }

}  // namespace fusebench::simulator::scene
