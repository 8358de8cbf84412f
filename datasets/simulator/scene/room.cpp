#include "datasets/simulator/scene/room.hpp"

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furnishing.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"

namespace fusebench::simulator::scene {

namespace {

// Largest depth of furniture from the walls, and its height in the middle.
constexpr double kFurnitureReach_m = 1.4;
constexpr double kTableTop_m = 0.9;

class RoomPlan {
 public:
  explicit RoomPlan(std::uint64_t seed)
      : random_(random::mix_key(seed, 1)),
        textures_(paint_room_textures(builder_, random::mix_key(seed, 2))),
        furnisher_(builder_, textures_, random_),
        furnishing_(builder_, textures_, furnisher_, random_),
        half_m_(halves(random_)),
        height_m_(random_.uniform(2.65, 2.85)) {}

  SimulatedScene build() {
    furnishing_.floor_and_ceiling({}, half_m_, height_m_);
    furnishing_.seating_area({});
    beams_and_lamps();
    const int first = random_.below(4);
    const int step = random_.below(2) == 0 ? 1 : 3;  // clockwise or counter-clockwise
    furnishing_.books_wall(wall(first));
    furnishing_.desk_wall(wall(first + step));
    furnishing_.plain_wall(wall(first + 2 * step));
    furnishing_.sofa_wall(wall(first + 3 * step));
    SimulatedScene& scene = builder_.scene();
    const std::vector<Lamp> lamps = {{{0.9, 0.7, height_m_ - 0.45}, 1.3},
                                     {{-0.8, -0.9, height_m_ - 0.45}, 1.1}};
    bake_light(scene, lamps, 0.5);
    color_vertices(scene);
    const double x = half_m_.x() - kFurnitureReach_m;
    const double y = half_m_.y() - kFurnitureReach_m;
    scene.free_space = {Vector3d(-x, -y, kTableTop_m), Vector3d(x, y, 1.9)};
    scene.look_at = {Vector3d(0.3 - half_m_.x(), 0.3 - half_m_.y(), 0.3),
                     Vector3d(half_m_.x() - 0.3, half_m_.y() - 0.3, 1.9)};
    return std::move(scene);
  }

 private:
  static Vector2d halves(random::RandomSequence& random) {
    const double x = random.uniform(2.4, 2.7);
    const double y = random.uniform(2.4, 2.7);
    return {x, y};
  }

  [[nodiscard]] Wall wall(int index) const { return room_wall({}, half_m_, height_m_, index); }

  void beams_and_lamps() {
    for (const double at : {-1.2, 0.0, 1.2}) {
      builder_.add_box(placed({}, {0, at, height_m_ - 0.16}), {2 * half_m_.x(), 0.14, 0.16},
                       {.texture = textures_.dark_wood, .repeat_m = 0.8, .offset = {at, at}});
    }
    for (const Vector2d& at : {Vector2d(0.9, 0.7), Vector2d(-0.8, -0.9)})
      furnishing_.lamp_shade(placed({}, {at.x(), at.y(), height_m_ - 0.3}));
  }

  random::RandomSequence random_;
  RoomBuilder builder_;
  RoomTextures textures_;
  Furnisher furnisher_;
  RoomFurnishing furnishing_;
  Vector2d half_m_;
  double height_m_;
};

}  // namespace

SimulatedScene make_room(std::uint64_t seed) { return RoomPlan(seed).build(); }

}  // namespace fusebench::simulator::scene
