#include "datasets/simulator/scene/room_clutter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fusebench::simulator::scene {

namespace {

constexpr int kLabelSide_px = 256;

SE3 tilted(const SE3& T, const Vector3d& angles_rad) { return T * SE3{so3_exp(angles_rad), {0, 0, 0}}; }

}  // namespace

Clutter::Clutter(RoomBuilder& builder, const RoomTextures& textures, random::RandomSequence& random,
                 std::uint64_t key)
    : builder_(builder), textures_(textures), random_(random) {
  random::RandomSequence seeds(key);
  // Large shapes only, since fine print adds noise in near views.
  constexpr int kPictures = 7;
  for (int i = 0; i < kPictures; ++i)
    labels_.push_back(builder.add_texture(texture::paint_picture(kLabelSide_px, seeds.bits())));
  labels_.push_back(builder.add_texture(texture::paint_spines(kLabelSide_px, seeds.bits())));
}

Paint Clutter::label(double repeat_m) {
  return {.texture = labels_[static_cast<std::size_t>(random_.below(static_cast<int>(labels_.size())))],
          .repeat_m = repeat_m,
          .offset = {any(0, 1), any(0, 1)},
          .brightness = static_cast<float>(any(0.65, 1.15))};
}

void Clutter::bar(const Vector3d& from_room, const Vector3d& to_room, double thickness_m,
                  const Paint& paint) {
  const Vector3d along = to_room - from_room;
  const Quaterniond upright = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), along);
  builder_.add_box({upright, from_room}, {thickness_m, thickness_m, along.norm()}, paint);
}

void Clutter::poster(const SE3& T, double width_m, double height_m) {
  builder_.add_box(placed(T, {0, 0.002, 0}), {width_m, 0.004, height_m}, label(any(0.5, 0.8)));
}

void Clutter::can(const SE3& T, double max_height_m) {
  const double height = std::min(max_height_m, any(0.08, 0.16));
  const double radius = any(0.03, 0.043);
  builder_.add_cylinder(T, radius, height, label(0.3));
  builder_.add_cylinder(placed(T, {0, 0, height}), 0.92 * radius, 0.004,
                        {.texture = textures_.stone, .repeat_m = 0.1});
}

void Clutter::bottle(const SE3& T, double max_height_m) {
  const double height = std::min(max_height_m, any(0.2, 0.29));
  const double radius = any(0.028, 0.038);
  builder_.add_cylinder(T, radius, 0.58 * height, label(0.3));
  const Paint glass = label(0.35);
  builder_.add_frustum(placed(T, {0, 0, 0.58 * height}), radius, 0.013, 0.17 * height, glass);
  builder_.add_cylinder(placed(T, {0, 0, 0.75 * height}), 0.013, 0.21 * height, glass);
  builder_.add_cylinder(placed(T, {0, 0, 0.94 * height}), 0.015, 0.06 * height,
                        {.texture = textures_.metal, .repeat_m = 0.1});
}

void Clutter::box(const SE3& T, double max_height_m) {
  const Vector3d size(any(0.05, 0.11), any(0.05, 0.11), std::min(max_height_m, any(0.07, 0.24)));
  builder_.add_box(placed(T, {0, 0, 0}, any(-1.5, 1.5)), size, label(0.42));
}

void Clutter::leaning_books(const SE3& T, double width_m, double max_height_m) {
  const double lean_rad = any(0.08, 0.3);
  const double run_m = std::sin(lean_rad) * max_height_m;
  double x = -0.5 * width_m;
  while (true) {
    const double thickness = any(0.012, 0.04);
    if (x + thickness + run_m > 0.5 * width_m) break;
    const double height = (max_height_m - thickness * std::sin(lean_rad)) * any(0.6, 1.0);
    const SE3 T_book =
        tilted(placed(T, {x, any(-0.03, 0.03), 0.5 * thickness * std::sin(lean_rad)}), {0, lean_rad, 0});
    builder_.add_box(placed(T_book, {0.5 * thickness, 0, 0}), {0.94 * thickness, any(0.12, 0.17), height},
                     label(0.7), {.texture = textures_.pages[0], .repeat_m = 0.3});
    x += thickness / std::cos(lean_rad);
    if (random_.below(5) == 0) x += any(0.01, 0.05);
  }
}

void Clutter::plates(const SE3& T, double width_m, double max_height_m) {
  const double radius = std::min(0.5 * max_height_m, any(0.08, 0.12));
  const double turn_rad = any(0.5, 1.1);  // visible behind each other
  for (double x = 0.5 * radius - 0.5 * width_m; x < 0.5 * (width_m - radius); x += any(0.03, 0.055)) {
    builder_.add_ellipsoid(tilted(placed(T, {x, 0, radius}, turn_rad), {0, 0.12, 0}), {0.006, radius, radius},
                           label(0.36));
  }
  for (const double y : {-0.05, 0.05}) {
    bar(T * Vector3d(-0.5 * width_m, y, 0.02), T * Vector3d(0.5 * width_m, y, 0.02), 0.012,
        {.texture = textures_.light_wood, .repeat_m = 0.2});
  }
}

void Clutter::pencils(const SE3& T, double max_height_m) {
  constexpr double kPot_m = 0.09;
  builder_.add_frustum(T, 0.034, 0.04, kPot_m, label(0.13));
  const int count = 5 + random_.below(5);
  for (int i = 0; i < count; ++i) {
    const double angle = any(0, 2 * std::numbers::pi);
    const double top_m = std::min(max_height_m, any(0.14, 0.2));
    const Vector3d outward(std::cos(angle), std::sin(angle), 0);
    const Vector3d above = any(0.4, 1.0) * 0.06 * outward + Vector3d(0, 0, top_m);
    bar(T * (0.02 * outward + Vector3d(0, 0, 0.6 * kPot_m)), T * above, any(0.006, 0.009), label(0.06));
  }
}

void Clutter::leaf(const SE3& T, double length_m) {
  builder_.add_ellipsoid(placed(T, {0.5 * length_m, 0, 0}), {0.5 * length_m, 0.2 * length_m, 0.002},
                         {.texture = textures_.leaf,
                          .repeat_m = 0.09,
                          .offset = {any(0, 1), any(0, 1)},
                          .brightness = static_cast<float>(any(0.6, 1.4))});
}

void Clutter::pot_plant(const SE3& T, double max_height_m) {
  constexpr double kPot_m = 0.09;
  builder_.add_frustum(T, 0.04, 0.055, kPot_m, {.texture = textures_.bricks, .repeat_m = 0.25});
  const int stalks = 6 + random_.below(4);
  for (int i = 0; i < stalks; ++i) {
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const Vector3d outward(std::cos(angle), std::sin(angle), 0);
    const double top_m = std::min(max_height_m - 0.02, kPot_m + any(0.05, 0.16));
    const Vector3d tip = any(0.02, 0.05) * outward + Vector3d(0, 0, top_m);
    bar(T * (0.01 * outward + Vector3d(0, 0, kPot_m - 0.01)), T * tip, 0.004,
        {.texture = textures_.leaf, .repeat_m = 0.1, .brightness = 0.6F});
    leaf(tilted(placed(T, tip, angle), {any(-0.4, 0.4), any(-0.2, 0.6), 0}), any(0.04, 0.07));
  }
}

void Clutter::wire_basket(const SE3& T, double width_m, double depth_m, double max_height_m) {
  const double height = std::min(0.8 * max_height_m, any(0.12, 0.18));
  constexpr double kWire_m = 0.005;
  const Paint wire{
      .texture = textures_.metal, .repeat_m = 0.3, .brightness = static_cast<float>(any(0.5, 1.6))};
  const Vector2d half(0.5 * width_m, 0.5 * depth_m);
  for (const double z : {0.01, 0.5 * height, height}) {
    for (const double side : {-1.0, 1.0}) {
      bar(T * Vector3d(-half.x(), side * half.y(), z), T * Vector3d(half.x(), side * half.y(), z), kWire_m,
          wire);
      bar(T * Vector3d(side * half.x(), -half.y(), z), T * Vector3d(side * half.x(), half.y(), z), kWire_m,
          wire);
    }
  }
  const int bars = static_cast<int>(width_m / 0.035);
  for (int i = 0; i <= bars; ++i) {
    const double x = -half.x() + width_m * i / bars;
    for (const double y : {-half.y(), half.y()})
      bar(T * Vector3d(x, y, 0), T * Vector3d(x, y, height), kWire_m, wire);
  }
  for (double x = -half.x() + 0.06; x < half.x() - 0.05; x += any(0.09, 0.12)) {  // what it holds
    const SE3 T_thing = placed(T, {x, any(-0.25, 0.05) * depth_m, 0.012});
    if (random_.below(2) == 0) {
      can(T_thing, max_height_m - 0.03);
    } else {
      builder_.add_ellipsoid(placed(T_thing, {0, 0, 0.042}), {0.042, 0.042, 0.042}, label(0.27));
    }
  }
}

void Clutter::slatted_crate(const SE3& T, double width_m, double depth_m, double max_height_m) {
  const double height = std::min(0.75 * max_height_m, any(0.16, 0.22));
  const Paint wood{.texture = textures_.light_wood, .repeat_m = 0.35, .offset = {any(0, 1), any(0, 1)}};
  builder_.add_box(T, {width_m, depth_m, 0.01}, wood);
  for (double z = 0.015; z + 0.03 < height; z += 0.055) {
    for (const double y : {-0.5, 0.5})
      builder_.add_box(placed(T, {0, y * depth_m, z}), {width_m, 0.008, 0.03}, wood);
    for (const double x : {-0.5, 0.5})
      builder_.add_box(placed(T, {x * width_m, 0, z}), {0.008, depth_m, 0.03}, wood);
  }
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.45, 0.45})
      builder_.add_box(placed(T, {x * (width_m - 0.03), y * depth_m, 0}), {0.025, 0.016, height}, wood);
  }
  for (double x = -0.5 * width_m + 0.06; x < 0.5 * width_m - 0.05; x += any(0.08, 0.13))
    bottle(placed(T, {x, any(-0.2, 0.2) * depth_m, 0.011}), max_height_m - 0.02);
}

void Clutter::cable(const Vector3d& from_room, const Vector3d& to_room, double sag_m) {
  constexpr int kPieces = 14;
  const Paint paint = label(0.08);
  const auto at = [&](int i) {
    const double share = static_cast<double>(i) / kPieces;
    return Vector3d(from_room + share * (to_room - from_room) -
                    4 * sag_m * share * (1 - share) * Vector3d::UnitZ());
  };
  for (int i = 0; i < kPieces; ++i) bar(at(i), at(i + 1), 0.007, paint);
}

void Clutter::creeper(const SE3& T, double length_m) {
  Vector3d from(0, 0, 0);
  for (double z = 0.03; z < length_m; z += 0.03) {
    const Vector3d to(any(-0.02, 0.02), any(-0.012, 0.012), -z);
    bar(T * from, T * to, 0.003, {.texture = textures_.leaf, .repeat_m = 0.1, .brightness = 0.5F});
    leaf(tilted(placed(T, to, any(-3.1, 3.1)), {any(-0.5, 0.5), any(0.2, 1.1), 0}), any(0.025, 0.045));
    from = to;
  }
}

/// Returns the used width.
double Clutter::wide_object(const SE3& T_left, double room_m, double depth_m, double max_height_m) {
  const double width = std::min(room_m, any(0.2, 0.38));
  const SE3 T = placed(T_left, {0.5 * width, 0, 0});
  switch (random_.below(5)) {
    case 0:
      leaning_books(T, width, max_height_m);
      break;
    case 1:
      plates(T, width, max_height_m);
      break;
    case 2:
      wire_basket(T, width - 0.02, std::min(depth_m, 0.24), max_height_m);
      break;
    case 3:
      slatted_crate(T, width - 0.02, std::min(depth_m, 0.24), max_height_m);
      break;
    default:
      for (double x = 0.05 - 0.5 * width; x < 0.5 * width - 0.04; x += any(0.08, 0.13)) {
        box(placed(T, {x, any(-0.09, -0.02), 0}), max_height_m);
        if (random_.below(2) == 0) can(placed(T, {x + 0.03, any(0.08, 0.11), 0}), 0.7 * max_height_m);
      }
  }
  return width;
}

double Clutter::slender_object(const SE3& T_left, double max_height_m) {
  const double width = any(0.09, 0.13);
  const SE3 T = placed(T_left, {0.5 * width, 0, 0}, any(-0.5, 0.5));
  switch (random_.below(5)) {
    case 0:
      can(T, max_height_m);
      break;
    case 1:
      bottle(T, max_height_m);
      break;
    case 2:
      pencils(T, max_height_m);
      break;
    case 3:
      pot_plant(T, max_height_m);
      break;
    default:
      box(T, max_height_m);
  }
  return width;
}

void Clutter::fill_board(const SE3& T, const Vector3d& clear_m) {
  const double half = 0.5 * clear_m.x();
  double x = -half + 0.01;
  while (half - x > 0.14) {
    const double room_m = half - x - 0.01;
    if (room_m > 0.22 && random_.below(5) < 2) {
      x += wide_object(placed(T, {x, -0.02, 0}), room_m, clear_m.y() - 0.08, clear_m.z());
    } else {
      // One behind the other, not aligned, so that both are visible.
      const double back_m = 0.06 - 0.5 * clear_m.y();
      if (random_.below(4) != 0) slender_object(placed(T, {x, back_m + any(0, 0.05), 0}), clear_m.z());
      x += slender_object(placed(T, {x + any(0, 0.03), -back_m - any(0.01, 0.1), 0}), 0.75 * clear_m.z());
    }
    x += any(0.0, 0.05);
  }
}

}  // namespace fusebench::simulator::scene
