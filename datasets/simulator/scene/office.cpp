#include "datasets/simulator/scene/office.hpp"

#include <numbers>
#include <utility>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/room_builder.hpp"
#include "datasets/simulator/scene/room_clutter.hpp"
#include "datasets/simulator/scene/room_furniture.hpp"
#include "datasets/simulator/scene/room_lighting.hpp"

namespace fusebench::simulator::scene {

namespace {

constexpr double kHalfX_m = 2.7;
constexpr double kHalfY_m = 2.4;
constexpr double kHeight_m = 2.7;
constexpr double kTop_m = 0.74;
constexpr double kDeskDepth_m = 0.95;
constexpr double kDeskWidth_m = 3.6;
constexpr int kScreenPages = 4;

class OfficePlan {
 public:
  explicit OfficePlan(std::uint64_t seed)
      : random_(random::mix_key(seed, 11)),
        textures_(paint_room_textures(builder_, random::mix_key(seed, 12))),
        furnisher_(builder_, textures_, random_),
        clutter_(builder_, textures_, random_, random::mix_key(seed, 13)) {
    const auto plain = [&](std::uint32_t srgb) {
      return builder_.add_texture(texture::paint_plain(texture::reflectance_of(srgb)));
    };
    black_ = plain(0x0e0e10);
    beige_ = plain(0xc8c2b0);
    white_ = plain(0xeeeae2);
    blue_ = plain(0x1d2f7c);
    red_ = plain(0xb01c1c);
    desk_top_ = builder_.add_texture(texture::paint_wood(512, texture::reflectance_of(0xe2d9c8),
                                                         texture::reflectance_of(0xb4a58c), 1, seed));
    screen_ = builder_.add_texture(texture::paint_page(256, random::mix_key(seed, 14)));
    for (int i = 1; i < kScreenPages; ++i) {
      const std::uint64_t key = random::mix_key(seed, 14 + static_cast<std::uint64_t>(i));
      builder_.add_texture(i % 2 == 1 ? texture::paint_picture(256, key) : texture::paint_page(256, key));
    }
  }

  SimulatedScene build() {
    shell();
    desk(placed(wall(1), {0, 0.5 * kDeskDepth_m + 0.02, kTop_m}));
    furnisher_.bookshelf(placed(wall(0), {0.7, 0.17, 0}), 1.7, 2.0);
    furnisher_.window(placed(wall(0), {-1.2, 0, 0.95}));
    furnisher_.cabinet(placed(wall(2), {-0.8, 0.24, 0}), 1.5, 0.9);
    furnisher_.picture(placed(wall(2), {-0.8, 0, 1.6}), 0.9, 0.6);
    furnisher_.bookshelf(placed(wall(2), {1.3, 0.17, 0}), 1.4, 1.9);
    furnisher_.door(placed(wall(3), {1.2, 0, 0}));
    furnisher_.sofa(placed(wall(3), {-0.8, 0.5, 0}));
    furnisher_.picture(placed(wall(3), {-0.8, 0, 1.6}), 0.8, 0.6);
    furnisher_.chair(placed({}, {1.1, -1.3, 0}, 1.2));
    SimulatedScene& scene = builder_.scene();
    scene.gloss.assign(scene.textures.size(), 0.0F);
    const auto shine = [&](std::int32_t texture, float gloss) {
      scene.gloss[static_cast<std::size_t>(texture)] = gloss;
    };
    shine(black_, 0.9F);
    for (int i = 0; i < kScreenPages; ++i) shine(screen_ + i, 0.8F);
    shine(beige_, 0.3F);
    shine(white_, 0.7F);
    shine(textures_.metal, 0.6F);
    for (const std::int32_t picture : textures_.pictures) shine(picture, 0.5F);
    shine(desk_top_, 0.25F);
    const std::vector<Lamp> lamps = {{{0.9, 0.8, kHeight_m - 0.2}, 1.9}, {{0.5, -1.0, kHeight_m - 0.2}, 1.7}};
    bake_light(scene, lamps, 0.6);
    for (const Lamp& lamp : lamps) scene.highlights.push_back({lamp.position.cast<float>(), 0.5F});
    scene.screens = {screen_, kScreenPages};
    color_vertices(scene);
    const double edge_m = kHalfX_m - kDeskDepth_m;
    scene.free_space = {Vector3d(edge_m - 0.75, -1.2, 1.1), Vector3d(edge_m + 0.45, 1.2, 1.65)};
    scene.face_rad = 0;
    scene.look_at = {Vector3d(edge_m, -0.5 * kDeskWidth_m, kTop_m),
                     Vector3d(kHalfX_m, 0.5 * kDeskWidth_m, 1.6)};
    return std::move(scene);
  }

 private:
  /// Frame of a wall: origin at its foot in the middle, y into the room; wall 1 is towards +x.
  [[nodiscard]] static SE3 wall(int index) {
    const Quaterniond turn = so3_exp({0, 0, index * 0.5 * std::numbers::pi});
    return {turn, turn * Vector3d(0, index % 2 == 0 ? -kHalfY_m : -kHalfX_m, 0)};
  }
  [[nodiscard]] double any(double low, double high) { return random_.uniform(low, high); }

  void shell() {
    const Vector3d x(2 * kHalfX_m, 0, 0);
    const Vector3d y(0, 2 * kHalfY_m, 0);
    const Vector3d corner(-kHalfX_m, -kHalfY_m, 0);
    builder_.add_rectangle(corner, x, y, {.texture = textures_.floor, .repeat_m = 1.1, .brightness = 0.6F});
    builder_.add_rectangle(corner + Vector3d(0, 0, kHeight_m), y, x,
                           {.texture = textures_.ceiling, .repeat_m = 1.6});
    const std::array<Paint, 4> paints = {Paint{.texture = textures_.plaster, .repeat_m = 1.2},
                                         Paint{.texture = textures_.plain, .repeat_m = 1},
                                         Paint{.texture = textures_.wallpaper, .repeat_m = 1.1},
                                         Paint{.texture = textures_.bricks, .repeat_m = 0.9}};
    for (int i = 0; i < 4; ++i) {
      const SE3 T = wall(i);
      const double length_m = 2 * (i % 2 == 0 ? kHalfX_m : kHalfY_m);
      builder_.add_rectangle(T * Vector3d(0.5 * length_m, 0, 0), T.rotation * Vector3d(-length_m, 0, 0),
                             {0, 0, kHeight_m}, paints[static_cast<std::size_t>(i)]);
    }
  }

  /// Frame: on the top, in its middle, y towards the seat.
  void desk(const SE3& T) {
    builder_.add_box(placed(T, {0, 0, -0.03}), {kDeskWidth_m, kDeskDepth_m, 0.03},
                     {.texture = desk_top_, .repeat_m = 0.9});
    for (const double x : {-0.47, 0.0, 0.47}) {
      builder_.add_box(placed(T, {x * kDeskWidth_m, 0, -kTop_m}), {0.05, 0.8, kTop_m - 0.03},
                       {.texture = black_});
    }
    for (int i = 0; i < 5; ++i) {  // notes and pictures above
      furnisher_.picture(placed(T, {-1.4 + 0.7 * i + any(-0.1, 0.1), -0.5 * kDeskDepth_m, any(0.75, 1.0)}),
                         any(0.3, 0.5), any(0.25, 0.45));
    }
    // A dark screen of cloth along the back.
    builder_.add_box(placed(T, {0, -0.5 * kDeskDepth_m + 0.01, 0}), {kDeskWidth_m, 0.03, 0.62},
                     {.texture = textures_.fabrics[1], .repeat_m = 0.3, .brightness = 0.2F});
    for (const double x : {-1.1, 0.0, 1.1}) place_of_work(placed(T, {x, 0, 0}));
  }

  void place_of_work(const SE3& T) {
    screen(placed(T, {any(-0.25, -0.15), any(-0.25, -0.18), 0}, any(-0.3, 0.0)), random_.below(4) == 0);
    screen(placed(T, {any(0.3, 0.36), any(-0.22, -0.12), 0}, any(0.1, 0.4)), random_.below(4) == 0);
    keyboard(placed(T, {any(-0.02, 0.08), any(0.1, 0.2), 0}, any(-0.35, 0.35)));
    mouse(placed(T, {any(0.33, 0.38), any(0.08, 0.2), 0}, any(-0.4, 0.4)));
    furnisher_.papers(placed(T, {any(-0.4, -0.3), any(0.2, 0.26), 0}), 0.13, 4);
    furnisher_.papers(placed(T, {0.45, any(0.28, 0.33), 0}), 0.1, 3);
    clutter_.pencils(placed(T, {-0.2, any(-0.1, -0.05), 0}), 0.2);
    builder_.add_cylinder(placed(T, {-0.16, any(0.0, 0.06), 0}), 0.042, 0.1,
                          {.texture = random_.below(2) == 0 ? white_ : red_});
    furnisher_.carton(placed(T, {-0.28, any(0.0, 0.06), 0}, any(-0.8, 0.8)), {0.09, 0.07, any(0.12, 0.2)});
    furnisher_.stack_of_books(placed(T, {-0.45, any(-0.36, -0.33), 0}, any(-0.6, 0.6)), 1 + random_.below(4));
    telephone(placed(T, {-0.42, any(-0.12, -0.06), 0}, any(-0.4, 0.4)));
    for (int i = 0; i < 8; ++i) small_thing(placed(T, {any(-0.3, 0.5), any(0.0, 0.42), 0}, any(-1.5, 1.5)));
    for (int i = 0; i < 4; ++i) {
      const double x = any(-0.5, 0.3);
      const double y = any(-0.4, 0.1);
      cord(T * Vector3d(x, y, 0.006), T * Vector3d(x + any(0.1, 0.4), y + any(-0.15, 0.15), 0.006));
    }
  }

  void screen(const SE3& T, bool lit) {
    builder_.add_cylinder(T, any(0.09, 0.13), 0.012, {.texture = black_});
    builder_.add_box(placed(T, {0, -0.02, 0.01}), {0.05, 0.04, 0.12}, {.texture = black_});
    const double width = any(0.46, 0.54);
    builder_.add_box(placed(T, {0, 0, 0.08}), {width, 0.05, 0.35}, {.texture = black_});
    if (!lit) return;
    const double inner = width - 0.04;
    builder_.add_rectangle(T * Vector3d(0.5 * inner, 0.027, 0.1), T.rotation * Vector3d(-inner, 0, 0),
                           T.rotation * Vector3d(0, 0, 0.31),
                           {.texture = screen_, .repeat_m = 0, .brightness = 1.3F});
  }

  void keyboard(const SE3& T) {
    const std::int32_t body = random_.below(3) == 0 ? black_ : beige_;
    builder_.add_box(T, {0.45, 0.16, 0.018}, {.texture = body, .brightness = 0.8F});
    const std::int32_t keys = body == black_ ? textures_.metal : white_;
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 21; ++column) {
        if (column == 14 || column == 18 || (row == 5 && column % 3 == 0)) continue;
        builder_.add_box(placed(T, {0.0205 * (column - 10), 0.023 * (row - 2.5), 0.018}),
                         {0.015, 0.016, 0.006},
                         {.texture = keys, .repeat_m = 0.3, .brightness = static_cast<float>(any(0.7, 0.9))},
                         {.texture = textures_.pages[1], .repeat_m = 0.11, .offset = {any(0, 1), any(0, 1)}});
      }
    }
  }

  void mouse(const SE3& T) {
    builder_.add_ellipsoid(placed(T, {0, 0, 0.012}), {0.03, 0.055, 0.022},
                           {.texture = random_.below(2) == 0 ? black_ : beige_});
  }

  void telephone(const SE3& T) {
    const Paint body{.texture = beige_, .brightness = 0.9F};
    builder_.add_box(T, {0.19, 0.22, 0.04}, body);
    builder_.add_box(placed(T, {-0.065, 0, 0.041}), {0.045, 0.21, 0.03}, body);
    for (int i = 0; i < 12; ++i) {
      builder_.add_box(placed(T, {0.0 + 0.028 * (i % 3), -0.05 + 0.03 * (i / 3), 0.041}),
                       {0.018, 0.016, 0.006}, {.texture = i % 2 == 0 ? white_ : black_});
    }
    builder_.add_rectangle(T * Vector3d(0.09, -0.07, 0.041), T.rotation * Vector3d(-0.11, 0, 0),
                           T.rotation * Vector3d(0, -0.03, 0),
                           {.texture = textures_.pages[0], .repeat_m = 0});
  }

  void small_thing(const SE3& T) {
    const std::array<std::int32_t, 5> colors = {black_, blue_, red_, white_, textures_.metal};
    const Paint paint{.texture = colors[static_cast<std::size_t>(random_.below(5))], .repeat_m = 0.2};
    if (random_.below(2) == 0) {
      builder_.add_box(T, {any(0.03, 0.09), any(0.02, 0.05), any(0.012, 0.04)}, paint);
    } else {
      builder_.add_box(T, {any(0.1, 0.16), 0.009, 0.009}, paint);
    }
  }

  /// A cable on the desk in a curve.
  void cord(const Vector3d& from_room, const Vector3d& to_room) {
    const Vector3d across = Vector3d::UnitZ().cross(to_room - from_room) * any(-0.5, 0.5);
    constexpr int kPieces = 8;
    Vector3d last = from_room;
    for (int i = 1; i <= kPieces; ++i) {
      const double s = static_cast<double>(i) / kPieces;
      const Vector3d next = from_room + s * (to_room - from_room) + 4 * s * (1 - s) * across;
      const Vector3d along = next - last;
      const Quaterniond upright = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along);
      builder_.add_box({upright, last}, {0.006, 0.006, along.norm()}, {.texture = black_});
      last = next;
    }
  }

  random::RandomSequence random_;
  RoomBuilder builder_;
  RoomTextures textures_;
  Furnisher furnisher_;
  Clutter clutter_;
  std::int32_t black_ = 0;
  std::int32_t beige_ = 0;
  std::int32_t white_ = 0;
  std::int32_t blue_ = 0;
  std::int32_t red_ = 0;
  std::int32_t desk_top_ = 0;
  std::int32_t screen_ = 0;
};

}  // namespace

SimulatedScene make_office(std::uint64_t seed) { return OfficePlan(seed).build(); }

}  // namespace fusebench::simulator::scene
