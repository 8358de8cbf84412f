#include <algorithm>
#include <numbers>

#include "datasets/simulator/scene/room_furniture.hpp"

namespace fusebench::simulator::scene {

Paint Furnisher::cover() {
  return {.texture = textures_.spines[static_cast<std::size_t>(random_.below(2))],
          .repeat_m = 0.7,
          .offset = {any(0, 1), any(0, 1)},
          .brightness = static_cast<float>(any(0.7, 1.1))};
}

void Furnisher::books(const SE3& T, double width_m, double max_height_m) {
  double x = -0.5 * width_m;
  while (true) {
    const double thickness = any(0.018, 0.055);
    if (x + thickness > 0.5 * width_m) break;
    const double height = max_height_m * any(0.65, 1.0);
    const double depth = any(0.15, 0.2);
    Paint paint = cover();
    paint.repeat_m = 0.62;
    builder_.add_box(placed(T, {x + 0.5 * thickness, any(-0.02, 0.02), 0}), {0.94 * thickness, depth, height},
                     paint, {.texture = textures_.pages[0], .repeat_m = 0.4});
    x += thickness;
    if (random_.below(9) == 0) x += any(0.03, 0.08);  // gap of a missing book
  }
}

void Furnisher::stack_of_books(const SE3& T, int count) {
  double z = 0;
  for (int i = 0; i < count; ++i) {
    const double thickness = any(0.015, 0.045);
    const Vector3d size(any(0.15, 0.2), any(0.2, 0.27), thickness);
    builder_.add_box(placed(T, {any(-0.015, 0.015), any(-0.015, 0.015), z}, any(-0.3, 0.3)), size, cover());
    z += thickness + 0.001;
  }
}

void Furnisher::papers(const SE3& T, double reach_m, int count) {
  for (int i = 0; i < count; ++i) {
    const Paint page{.texture = textures_.pages[static_cast<std::size_t>(random_.below(2))], .repeat_m = 0};
    const SE3 T_sheet = placed(T, {any(-reach_m, reach_m), any(-0.5, 0.5) * reach_m, 0.003 * i}, any(-1, 1));
    builder_.add_box(T_sheet, {0.21, 0.297, 0.002}, page);
  }
}

void Furnisher::carton(const SE3& T, const Vector3d& size) {
  Paint paint = cover();
  paint.repeat_m = 0.45;
  builder_.add_box(T, size, paint);
}

void Furnisher::mug(const SE3& T) {
  builder_.add_cylinder(
      T, 0.042, 0.1,
      {.texture = textures_.pictures[static_cast<std::size_t>(random_.below(5))], .repeat_m = 0});
}

void Furnisher::vase(const SE3& T) {
  const Paint paint{.texture = textures_.wallpaper, .repeat_m = 0.3, .offset = {any(0, 1), any(0, 1)}};
  builder_.add_frustum(T, 0.05, 0.09, 0.12, paint);
  builder_.add_frustum(placed(T, {0, 0, 0.12}), 0.09, 0.035, 0.12, paint);
}

void Furnisher::plant(const SE3& T, double height_m) {
  builder_.add_frustum(T, 0.13, 0.18, 0.3, {.texture = textures_.bricks, .repeat_m = 0.4});
  builder_.add_cylinder(placed(T, {0, 0, 0.3}), 0.015, 0.6 * height_m, wood(true));
  constexpr int kLeaves = 26;
  for (int i = 0; i < kLeaves; ++i) {
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double z = 0.3 + height_m * (0.25 + 0.75 * i / kLeaves) * 0.85;
    const double reach = any(0.1, 0.24);
    const SE3 T_leaf =
        placed(T, {0, 0, z}, angle) * SE3{so3_exp({any(-0.5, 0.5), any(-0.7, 0.2), 0}), {0, 0, 0}};
    builder_.add_ellipsoid(
        placed(T_leaf, {reach, 0, 0}), {0.14, 0.05, 0.012},
        {.texture = textures_.leaf, .repeat_m = 0.2, .brightness = static_cast<float>(any(0.7, 1.2))});
  }
}

void Furnisher::table_lamp(const SE3& T, double height_m) {
  const Paint metal{.texture = textures_.metal, .repeat_m = 0.3};
  builder_.add_cylinder(T, 0.08, 0.02, metal);
  builder_.add_cylinder(placed(T, {0, 0, 0.02}), 0.012, height_m - 0.2, metal);
  builder_.add_frustum(placed(T, {0, 0, height_m - 0.18}), 0.13, 0.08, 0.18,
                       {.texture = textures_.fabrics[1], .repeat_m = 0.25, .brightness = 1.2F});
}

void Furnisher::monitor(const SE3& T) {
  const Paint metal{.texture = textures_.metal, .repeat_m = 0.3};
  builder_.add_box(T, {0.22, 0.16, 0.015}, metal);
  builder_.add_box(placed(T, {0, -0.03, 0.015}), {0.05, 0.03, 0.12}, metal);
  builder_.add_box(placed(T, {0, 0, 0.11}), {0.56, 0.04, 0.34}, metal);
  builder_.add_rectangle(T * Vector3d(0.265, 0.022, 0.125), T.rotation * Vector3d(-0.53, 0, 0),
                         T.rotation * Vector3d(0, 0, 0.31), {.texture = textures_.pages[1], .repeat_m = 0});
}

void Furnisher::picture(const SE3& T, double width_m, double height_m) {
  builder_.add_box(placed(T, {0, 0.015, -0.5 * height_m}), {width_m, 0.03, height_m},
                   wood(random_.below(2) == 0));
  const double inner_w = width_m - 0.06;
  const double inner_h = height_m - 0.06;
  builder_.add_rectangle(
      T * Vector3d(0.5 * inner_w, 0.033, -0.5 * inner_h), T.rotation * Vector3d(-inner_w, 0, 0),
      T.rotation * Vector3d(0, 0, inner_h),
      {.texture = textures_.pictures[static_cast<std::size_t>(random_.below(5))], .repeat_m = 0});
}

void Furnisher::door(const SE3& T) {
  builder_.add_box(placed(T, {0, 0.02, 0}), {1.0, 0.06, 2.1}, wood(true));
  builder_.add_box(placed(T, {0, 0.05, 0}), {0.88, 0.05, 2.03}, wood(false));
  for (const double x : {-0.2, 0.2}) {
    for (const double z : {0.2, 1.1}) builder_.add_box(placed(T, {x, 0.08, z}), {0.3, 0.02, 0.7}, wood(true));
  }
  builder_.add_ellipsoid(placed(T, {0.38, 0.12, 1.02}), {0.03, 0.03, 0.03},
                         {.texture = textures_.metal, .repeat_m = 0.2});
}

void Furnisher::window(const SE3& T) {
  constexpr double kWidth_m = 1.3;
  constexpr double kHeight_m = 1.2;
  builder_.add_box(placed(T, {0, 0.02, 0}), {kWidth_m, 0.05, kHeight_m}, wood(false));
  for (const double x : {-0.31, 0.31}) {
    for (const double z : {0.06, 0.64}) {  // panes with a blurred outdoor view
      builder_.add_rectangle(
          T * Vector3d(x + 0.28, 0.046, z), T.rotation * Vector3d(-0.56, 0, 0),
          T.rotation * Vector3d(0, 0, 0.5),
          {.texture = textures_.outdoors, .repeat_m = 0.9, .offset = {x, z}, .brightness = 1.4F});
    }
  }
  builder_.add_box(placed(T, {0, 0.12, -0.05}), {kWidth_m + 0.2, 0.24, 0.03},
                   {.texture = textures_.stone, .repeat_m = 0.4});
  for (const double side : {-1.0, 1.0}) {
    for (int fold = 0; fold < 5; ++fold) {  // curtains
      builder_.add_cylinder(placed(T, {side * (0.5 * kWidth_m + 0.02 + 0.055 * fold), 0.1, -0.45}), 0.035,
                            kHeight_m + 0.6,
                            {.texture = textures_.fabrics[2], .repeat_m = 0.4, .offset = {0.2 * fold, 0}});
    }
  }
}

void Furnisher::small_object(const SE3& T) {
  switch (random_.below(5)) {
    case 0:
      return vase(T);
    case 1:
      return mug(T);
    case 2:
      return carton(placed(T, {0, 0, 0}, any(-0.4, 0.4)), {any(0.08, 0.18), any(0.08, 0.15), any(0.06, 0.2)});
    case 3:
      return stack_of_books(T, 2 + random_.below(4));
    default:
      builder_.add_ellipsoid(
          placed(T, {0, 0, 0.075}), {0.075, 0.075, 0.075},
          {.texture = textures_.pictures[static_cast<std::size_t>(random_.below(5))], .repeat_m = 0});
  }
}

}  // namespace fusebench::simulator::scene
