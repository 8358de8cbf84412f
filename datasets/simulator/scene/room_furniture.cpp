#include "datasets/simulator/scene/room_furniture.hpp"

#include <numbers>

namespace fusebench::simulator::scene {

namespace {

/// One of a list of sRGB colours.
Eigen::Vector3f pick(random::RandomSequence& random, std::initializer_list<std::uint32_t> colors) {
  return texture::reflectance_of(colors.begin()[random.below(static_cast<int>(colors.size()))]);
}

}  // namespace

RoomTextures paint_room_textures(RoomBuilder& builder, std::uint64_t key) {
  random::RandomSequence random(key);
  const auto seed = [&] { return random.bits(); };
  RoomTextures t;
  t.plain = builder.add_texture(texture::paint_plain(pick(random, {0xd9d4c7, 0xcfd6d9, 0xd8cfc4})));
  t.plaster = builder.add_texture(
      texture::paint_plaster(512, pick(random, {0xb9b39f, 0xa3b2a8, 0xb0a8b5, 0xc0a890}), 0.55F, seed()));
  t.wallpaper = builder.add_texture(
      texture::paint_wallpaper(512, pick(random, {0xcdbf9e, 0xaebfc4, 0xc4b2b2}),
                               pick(random, {0x6b4a35, 0x34566b, 0x5a6b34, 0x7a3b3b}), seed()));
  t.bricks = builder.add_texture(texture::paint_bricks(512, pick(random, {0xa8543c, 0x9c6b4a, 0x8a8378}),
                                                       texture::reflectance_of(0xb8b2a6), seed()));
  t.floor = builder.add_texture(texture::paint_wood(512, pick(random, {0xc49a66, 0xa87c50, 0xb5a083}),
                                                    pick(random, {0x6e4524, 0x54381f}), 8, seed()));
  t.ceiling = builder.add_texture(texture::paint_speckles(512, texture::reflectance_of(0xd4d2ca),
                                                          texture::reflectance_of(0x77756e), seed()));
  t.rug = builder.add_texture(texture::paint_rug(512, pick(random, {0x7a2230, 0x22405e, 0x3d5a45}),
                                                 pick(random, {0xd8c79a, 0xc9853c, 0xb9b9c6}), seed()));
  t.light_wood = builder.add_texture(texture::paint_wood(256, texture::reflectance_of(0xd0ab78),
                                                         texture::reflectance_of(0x8a6238), 1, seed()));
  t.dark_wood = builder.add_texture(texture::paint_wood(256, texture::reflectance_of(0x8c5f3c),
                                                        texture::reflectance_of(0x3c2415), 1, seed()));
  t.tiles = builder.add_texture(texture::paint_tiles(
      512, pick(random, {0xc9d2d0, 0xd8cbb4}), pick(random, {0x4d7680, 0x7c5a4a, 0x52618a}), 8, seed()));
  t.stone = builder.add_texture(texture::paint_speckles(256, pick(random, {0x8f8f92, 0xa39a8c}),
                                                        texture::reflectance_of(0x2c2c30), seed()));
  t.metal =
      builder.add_texture(texture::paint_plaster(128, texture::reflectance_of(0x4b4f57), 0.35F, seed()));
  t.leaf = builder.add_texture(texture::paint_plaster(128, texture::reflectance_of(0x3f7036), 0.9F, seed()));
  t.outdoors =
      builder.add_texture(texture::paint_plaster(128, texture::reflectance_of(0xb4c3c4), 0.9F, seed()));
  for (auto& fabric : t.fabrics) {
    fabric = builder.add_texture(
        texture::paint_fabric(256, pick(random, {0x8a4b4b, 0x4b6a8a, 0x6f7d5a, 0x9a8866, 0x5d5470}),
                              pick(random, {0xe0d6bd, 0x2e3440, 0xc98f3f}), seed()));
  }
  for (auto& spines : t.spines) spines = builder.add_texture(texture::paint_spines(256, seed()));
  for (auto& page : t.pages) page = builder.add_texture(texture::paint_page(256, seed()));
  for (auto& picture : t.pictures) picture = builder.add_texture(texture::paint_picture(256, seed()));
  return t;
}

SE3 placed(const SE3& T_room_base, const Vector3d& at, double yaw_rad) {
  return T_room_base * SE3{so3_exp({0, 0, yaw_rad}), at};
}

Paint Furnisher::wood(bool dark) const {
  return {.texture = dark ? textures_.dark_wood : textures_.light_wood, .repeat_m = 0.6};
}

void Furnisher::legs(const SE3& T, double width_m, double depth_m, double height_m, const Paint& paint) {
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      builder_.add_box(placed(T, {x * (width_m - 0.06), y * (depth_m - 0.06), 0}), {0.045, 0.045, height_m},
                       paint);
    }
  }
}

void Furnisher::bookshelf(const SE3& T, double width_m, double height_m) {
  constexpr double kDepth_m = 0.3;
  constexpr double kBoard_m = 0.025;
  const Paint paint = wood(random_.below(2) == 0);
  builder_.add_box(placed(T, {0, -0.5 * kDepth_m + 0.01, 0}), {width_m, 0.02, height_m}, paint);
  for (const double side : {-0.5, 0.5}) {
    builder_.add_box(placed(T, {side * (width_m - kBoard_m), 0, 0}), {kBoard_m, kDepth_m, height_m}, paint);
  }
  const int shelves = static_cast<int>(height_m / 0.36);
  const double spacing_m = (height_m - kBoard_m) / shelves;
  const double inner_m = width_m - 2 * kBoard_m;
  for (int i = 0; i <= shelves; ++i) {
    const double z = i * spacing_m;
    builder_.add_box(placed(T, {0, 0, z}), {inner_m, kDepth_m - 0.02, kBoard_m}, paint);
    if (i == shelves) break;
    const SE3 T_board = placed(T, {0, 0, z + kBoard_m + 0.001});
    const double split = any(0.45, 0.8) * inner_m;
    books(placed(T_board, {-0.5 * (inner_m - split), -0.02, 0}), split - 0.02, spacing_m - 0.06);
    const double rest = inner_m - split;
    if (rest > 0.5)
      stack_of_books(placed(T_board, {-0.5 * inner_m + split + 0.14, 0, 0}), 3 + random_.below(4));
    small_object(placed(T_board, {0.5 * inner_m - 0.13, 0.02, 0}));
  }
  small_object(placed(T, {any(-0.3, 0.3) * width_m, 0, height_m + 0.001}));
}

void Furnisher::desk(const SE3& T) {
  constexpr double kWidth_m = 1.7;
  constexpr double kDepth_m = 0.75;
  constexpr double kHeight_m = 0.74;
  builder_.add_box(placed(T, {0, 0, kHeight_m - 0.03}), {kWidth_m, kDepth_m, 0.03}, wood(false));
  legs(T, kWidth_m, kDepth_m, kHeight_m - 0.03, {.texture = textures_.metal, .repeat_m = 0.3});
  builder_.add_box(placed(T, {0.55, 0, 0.05}), {0.42, 0.6, 0.6}, wood(true));
  for (int i = 0; i < 3; ++i) {  // drawers
    builder_.add_box(placed(T, {0.55, 0.305, 0.08 + 0.19 * i}), {0.38, 0.02, 0.17}, wood(false));
    builder_.add_box(placed(T, {0.55, 0.325, 0.15 + 0.19 * i}), {0.12, 0.02, 0.02},
                     {.texture = textures_.metal, .repeat_m = 0.2});
  }
  const SE3 T_top = placed(T, {0, 0, kHeight_m + 0.001});
  monitor(placed(T_top, {any(-0.25, -0.05), -0.2, 0}, any(-0.2, 0.2)));
  builder_.add_box(placed(T_top, {-0.12, 0.14, 0}, any(-0.1, 0.1)), {0.44, 0.14, 0.02},
                   {.texture = textures_.tiles, .repeat_m = 0.16, .brightness = 0.35F});
  papers(placed(T_top, {0.45, 0.12, 0}), 0.2, 5);
  papers(placed(T_top, {-0.6, 0.15, 0}), 0.12, 3);
  stack_of_books(placed(T_top, {-0.66, -0.15, 0}, any(-0.4, 0.4)), 5);
  mug(placed(T_top, {any(0.2, 0.25), 0.25, 0}));
  table_lamp(placed(T_top, {0.7, -0.22, 0}), 0.45);
  books(placed(T_top, {0.38, -0.25, 0}), 0.3, 0.28);
  carton(placed(T_top, {-0.42, -0.22, 0}, any(-0.5, 0.5)), {0.14, 0.1, any(0.06, 0.16)});
}

void Furnisher::chair(const SE3& T) {
  const Paint frame = wood(true);
  legs(T, 0.44, 0.44, 0.44, frame);
  builder_.add_box(placed(T, {0, 0, 0.44}), {0.46, 0.46, 0.05},
                   {.texture = textures_.fabrics[2], .repeat_m = 0.4});
  for (const double x : {-0.19, 0.19})
    builder_.add_box(placed(T, {x, -0.2, 0.48}), {0.04, 0.03, 0.44}, frame);
  for (int i = 0; i < 3; ++i)
    builder_.add_box(placed(T, {0, -0.2, 0.6 + 0.11 * i}), {0.36, 0.02, 0.06}, frame);
}

void Furnisher::sofa(const SE3& T) {
  const Paint cloth{.texture = textures_.fabrics[0], .repeat_m = 0.5};
  const Paint other{.texture = textures_.fabrics[1], .repeat_m = 0.35};
  builder_.add_box(placed(T, {0, 0, 0.06}), {1.9, 0.85, 0.3}, cloth);
  builder_.add_box(placed(T, {0, -0.33, 0.36}), {1.9, 0.2, 0.45}, cloth);
  for (const double x : {-0.86, 0.86})
    builder_.add_box(placed(T, {x, 0.08, 0.36}), {0.18, 0.69, 0.22}, cloth);
  for (const double x : {-0.385, 0.385}) {
    Paint seat = cloth;
    seat.offset = {any(0, 1), any(0, 1)};
    builder_.add_box(placed(T, {x, 0.09, 0.36}), {0.75, 0.66, 0.12}, seat);
  }
  for (const double x : {-0.6, any(-0.1, 0.1), 0.6}) {
    const SE3 T_cushion =
        placed(T, {x, -0.12, 0.66}, any(-0.3, 0.3)) * SE3{so3_exp({any(0.2, 0.4), 0, 0}), {0, 0, 0}};
    builder_.add_ellipsoid(T_cushion, {0.22, 0.09, 0.2}, other);
  }
}

void Furnisher::coffee_table(const SE3& T) {
  builder_.add_box(placed(T, {0, 0, 0.38}), {1.0, 0.6, 0.04}, wood(true),
                   {.texture = textures_.stone, .repeat_m = 0.4});
  legs(T, 1.0, 0.6, 0.38, wood(true));
  const SE3 T_top = placed(T, {0, 0, 0.421});
  papers(placed(T_top, {-0.22, 0.05, 0}), 0.18, 4);
  stack_of_books(placed(T_top, {0.3, -0.1, 0}, any(-0.6, 0.6)), 4);
  builder_.add_ellipsoid(placed(T_top, {0.02, 0.12, 0.07}), {0.11, 0.11, 0.07},
                         {.texture = textures_.tiles, .repeat_m = 0.3});
  mug(placed(T_top, {0.2, 0.2, 0}));
  builder_.add_box(placed(T, {0, 0, 0.12}), {0.86, 0.5, 0.02}, wood(true));
  carton(placed(T, {any(-0.2, 0.2), 0, 0.141}, any(-0.3, 0.3)), {0.3, 0.22, 0.16});
}

void Furnisher::cabinet(const SE3& T, double width_m, double height_m) {
  constexpr double kDepth_m = 0.42;
  builder_.add_box(T, {width_m, kDepth_m, height_m}, wood(false));
  const int doors = std::max(2, static_cast<int>(width_m / 0.45));
  const double door_m = width_m / doors;
  for (int i = 0; i < doors; ++i) {
    const double x = -0.5 * width_m + (i + 0.5) * door_m;
    builder_.add_box(placed(T, {x, 0.5 * kDepth_m, 0.04}), {door_m - 0.03, 0.02, height_m - 0.08},
                     wood(true));
    builder_.add_ellipsoid(placed(T, {x + 0.35 * door_m, 0.5 * kDepth_m + 0.02, 0.5 * height_m}),
                           {0.015, 0.015, 0.015}, {.texture = textures_.metal, .repeat_m = 0.1});
  }
  for (double x = -0.5 * width_m + 0.16; x < 0.5 * width_m - 0.12; x += 0.3) {
    small_object(placed(T, {x, any(-0.08, 0.08), height_m + 0.001}, any(-0.5, 0.5)));
  }
}

void Furnisher::shelf_of_jars(const SE3& T, int columns, int rows) {
  constexpr double kStep_m = 0.16;
  const double width_m = columns * kStep_m + 0.06;
  const Paint jar{.texture = textures_.tiles, .repeat_m = 0.3};
  const Paint lid{.texture = textures_.metal, .repeat_m = 0.2};
  for (int row = 0; row < rows; ++row) {
    const double z = 0.3 * row;
    builder_.add_box(placed(T, {0, 0.1, z}), {width_m, 0.2, 0.025}, wood(true));
    for (int column = 0; column < columns; ++column) {
      const double x = (column - 0.5 * (columns - 1)) * kStep_m;
      builder_.add_cylinder(placed(T, {x, 0.1, z + 0.026}), 0.05, 0.15, jar);
      builder_.add_cylinder(placed(T, {x, 0.1, z + 0.177}), 0.04, 0.03, lid);
    }
  }
}

}  // namespace fusebench::simulator::scene
