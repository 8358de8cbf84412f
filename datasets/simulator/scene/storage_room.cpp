#include "datasets/simulator/scene/storage_room.hpp"

#include <numbers>
#include <utility>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_clutter.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"

namespace fusebench::simulator::scene {

namespace {

constexpr double kHalf_m = 2.5;
constexpr double kHeight_m = 2.7;
constexpr double kRackWidth_m = 4.5;
constexpr double kRackHeight_m = 2.25;
constexpr double kRackDepth_m = 0.36;
constexpr double kGap_m = 0.07;       // between rack and wall
constexpr double kOverhang_m = 0.04;  // of leaves and cables, in front of the rack
constexpr double kPost_m = 0.028;
constexpr double kBoard_m = 0.02;

// Slab of camera positions.
constexpr double kNearest_m = 0.72;
constexpr double kSlab_m = 0.22;

class StorageRoomPlan {
 public:
  explicit StorageRoomPlan(std::uint64_t seed)
      : random_(random::mix_key(seed, 5)),
        textures_(paint_room_textures(builder_, random::mix_key(seed, 6))),
        furnisher_(builder_, textures_, random_),
        clutter_(builder_, textures_, random_, random::mix_key(seed, 7)) {}

  SimulatedScene build() {
    shell();
    rack(placed(wall(1), {0, kGap_m + 0.5 * kRackDepth_m, 0}));
    // Seldom in view.
    furnisher_.desk(placed(wall(0), {0.3, 0.42, 0}));
    furnisher_.bookshelf(placed(wall(3), {-0.6, 0.17, 0}), 1.6, 1.9);
    furnisher_.door(placed(wall(3), {1.3, 0, 0}));
    furnisher_.cabinet(placed(wall(2), {0.4, 0.24, 0}), 1.2, 0.8);
    SimulatedScene& scene = builder_.scene();
    const std::vector<Lamp> lamps = {{{0.6, 1.1, kHeight_m - 0.3}, 1.7}, {{0.4, -1.2, kHeight_m - 0.3}, 1.5}};
    bake_light(scene, lamps, 0.6);
    color_vertices(scene);
    const double front_m = kHalf_m - kGap_m - kRackDepth_m - kOverhang_m;
    scene.free_space = {Vector3d(front_m - kNearest_m - kSlab_m, -1.5, 0.8),
                        Vector3d(front_m - kNearest_m, 1.5, 1.75)};
    scene.look_at = {Vector3d(front_m, -0.5 * kRackWidth_m, 0.1),
                     Vector3d(kHalf_m, 0.5 * kRackWidth_m, kRackHeight_m)};
    scene.heading_rad = 0;
    return std::move(scene);
  }

 private:
  /// Frame of a wall: origin at its foot in the middle, y into the room; wall 1 is towards +x.
  [[nodiscard]] static SE3 wall(int index) {
    const Quaterniond turn = so3_exp({0, 0, index * 0.5 * std::numbers::pi});
    return {turn, turn * Vector3d(0, -kHalf_m, 0)};
  }

  void shell() {
    const double side = 2 * kHalf_m;
    const Vector3d corner(-kHalf_m, -kHalf_m, 0);
    builder_.add_rectangle(corner, {side, 0, 0}, {0, side, 0}, {.texture = textures_.floor, .repeat_m = 1.1});
    builder_.add_rectangle(corner + Vector3d(0, 0, kHeight_m), {0, side, 0}, {side, 0, 0},
                           {.texture = textures_.ceiling, .repeat_m = 1.6});
    const std::array<Paint, 4> paints = {Paint{.texture = textures_.wallpaper, .repeat_m = 1.1},
                                         Paint{.texture = textures_.bricks, .repeat_m = 0.8},
                                         Paint{.texture = textures_.plaster, .repeat_m = 1.2},
                                         Paint{.texture = textures_.wallpaper, .repeat_m = 1.1}};
    for (int i = 0; i < 4; ++i) {
      const SE3 T = wall(i);
      builder_.add_rectangle(T * Vector3d(kHalf_m, 0, 0), T.rotation * Vector3d(-side, 0, 0),
                             {0, 0, kHeight_m}, paints[static_cast<std::size_t>(i)]);
    }
  }

  void rack(const SE3& T) {
    constexpr int kBays = 6;
    constexpr double kBay_m = kRackWidth_m / kBays;
    for (int i = 0; i <= kBays; ++i) {
      for (const double y : {-0.5, 0.5}) {
        builder_.add_box(placed(T, {kBay_m * (i - 0.5 * kBays), y * (kRackDepth_m - kPost_m), 0}),
                         {kPost_m, kPost_m, kRackHeight_m},
                         {.texture = textures_.metal, .repeat_m = 0.8, .brightness = 1.4F});
      }
    }
    for (int i = 0; i < kBays; ++i) bay(placed(T, {kBay_m * (i + 0.5 - 0.5 * kBays), 0, 0}), kBay_m);
  }

  void bay(const SE3& T, double width_m) {
    const Paint board{.texture = random_.below(2) == 0 ? textures_.light_wood : textures_.dark_wood,
                      .repeat_m = 0.5,
                      .offset = {random_.uniform(0, 1), random_.uniform(0, 1)}};
    const Vector3d size(width_m - kPost_m - 0.002, kRackDepth_m - 0.01, kBoard_m);
    double z = 0.1;
    while (z < kRackHeight_m - 0.1) {
      const double clear_m = random_.uniform(0.24, 0.36);
      builder_.add_box(placed(T, {0, 0, z}), size, board);
      clutter_.fill_board(placed(T, {0, 0, z + kBoard_m + 0.001}), {size.x(), size.y(), clear_m - 0.02});
      if (random_.below(4) != 0) {
        clutter_.poster(placed(T, {random_.uniform(-0.1, 0.1), -0.5 * kRackDepth_m - kGap_m, z + 0.01}),
                        random_.uniform(0.35, 0.65), random_.uniform(0.18, 0.28));
      }
      hang(placed(T, {0, 0.5 * kRackDepth_m + 0.012, z}), size.x());
      z += clear_m + kBoard_m;
    }
  }

  /// Objects that hang from the front edge of a board.
  void hang(const SE3& T_edge, double width_m) {
    if (random_.below(3) == 0) {
      const double x = random_.uniform(-0.4, 0.1) * width_m;
      clutter_.cable(T_edge * Vector3d(x, 0, 0.01),
                     T_edge * Vector3d(x + random_.uniform(0.15, 0.4), 0, 0.01), random_.uniform(0.05, 0.2));
    }
    if (random_.below(2) == 0)
      clutter_.creeper(placed(T_edge, {random_.uniform(-0.4, 0.4) * width_m, 0, 0.02}),
                       random_.uniform(0.1, 0.3));
  }

  random::RandomSequence random_;
  RoomBuilder builder_;
  RoomTextures textures_;
  Furnisher furnisher_;
  Clutter clutter_;
};

}  // namespace

SimulatedScene make_storage_room(std::uint64_t seed) { return StorageRoomPlan(seed).build(); }

}  // namespace fusebench::simulator::scene
