#include "datasets/simulator/scene/corridor.hpp"

#include <utility>
#include <vector>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_furnishing.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"

namespace fusebench::simulator::scene {

namespace {

using Shape = CorridorShape;

class CorridorPlan {
 public:
  explicit CorridorPlan(std::uint64_t seed)
      : random_(random::mix_key(seed, 23)),
        textures_(paint_room_textures(builder_, random::mix_key(seed, 24))),
        furnisher_(builder_, textures_, random_),
        furnishing_(builder_, textures_, furnisher_, random_) {
    textures_.floor = textures_.stone;
  }

  SimulatedScene build() {
    const SE3 T_middle = placed({}, {0.5 * Shape::kLength_m, 0, 0});
    const Vector2d half_m(0.5 * Shape::kLength_m, 0.5 * Shape::kWidth_m);
    furnishing_.floor_and_ceiling(T_middle, half_m, Shape::kHeight_m);
    for (int index = 0; index < 4; ++index) {
      const Wall wall = room_wall(T_middle, half_m, Shape::kHeight_m, index);
      furnishing_.cover(wall, 0, Shape::kHeight_m, {.texture = textures_.plain, .repeat_m = 1});
      furnishing_.skirting(wall);
      if (index % 2 == 0) {
        along(wall);
      } else {
        furnisher_.door(placed(wall.T_scene_wall, {any(-0.3, 0.3), 0, 0}));
      }
    }
    return lit();
  }

 private:
  /// Objects on a long wall, with paint between them.
  void along(const Wall& wall) {
    double x = -0.5 * wall.length_m + any(0.8, 2.0);
    while (x < 0.5 * wall.length_m - 0.8) {
      thing(placed(wall.T_scene_wall, {x, 0, 0}));
      x += any(2.0, 4.0);
    }
  }

  void thing(const SE3& T) {
    switch (random_.below(4)) {
      case 0:
      case 1:
        return furnisher_.door(T);
      case 2:
        return furnisher_.picture(placed(T, {0, 0, any(1.5, 1.8)}), any(0.4, 0.7), any(0.3, 0.6));
      default:  // a notice
        builder_.add_rectangle(T * Vector3d(0.11, 0.004, any(1.3, 1.5)), T.rotation * Vector3d(-0.21, 0, 0),
                               {0, 0, 0.297}, {.texture = textures_.pages[0], .repeat_m = 0});
    }
  }

  SimulatedScene lit() {
    constexpr int kLamps = 7;
    SimulatedScene& scene = builder_.scene();
    std::vector<Lamp> lamps;
    for (int i = 0; i < kLamps; ++i) {
      const double x = Shape::kLength_m * (i + 0.5) / kLamps;
      lamps.push_back({{x, 0, Shape::kHeight_m - 0.25}, any(0.8, 1.1)});
    }
    bake_light(scene, lamps, 0.5);
    color_vertices(scene);
    scene.free_space = {Vector3d(1, -0.5, 0.9), Vector3d(0.5 * Shape::kLength_m, 0.5, 1.9)};
    scene.look_at = scene.free_space;
    return std::move(scene);
  }

  [[nodiscard]] double any(double low, double high) { return random_.uniform(low, high); }

  random::RandomSequence random_;
  RoomBuilder builder_;
  RoomTextures textures_;
  Furnisher furnisher_;
  RoomFurnishing furnishing_;
};

}  // namespace

SimulatedScene make_corridor(std::uint64_t seed) { return CorridorPlan(seed).build(); }

}  // namespace fusebench::simulator::scene
