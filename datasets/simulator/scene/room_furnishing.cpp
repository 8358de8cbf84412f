#include "datasets/simulator/scene/room_furnishing.hpp"

#include <numbers>

namespace fusebench::simulator::scene {

Wall room_wall(const SE3& T_scene_room, const Vector2d& half_m, double height_m, int index) {
  const bool across = index % 2 == 0;
  const Quaterniond turn = so3_exp({0, 0, (index % 4) * 0.5 * std::numbers::pi});
  const SE3 T_room_wall{turn, turn * Vector3d(0, across ? -half_m.y() : -half_m.x(), 0)};
  return {T_scene_room * T_room_wall, 2 * (across ? half_m.x() : half_m.y()), height_m};
}

void RoomFurnishing::cover(const Wall& wall, double low_m, double high_m, const Paint& paint) {
  builder_.add_rectangle(wall.T_scene_wall * Vector3d(0.5 * wall.length_m, 0, low_m),
                         wall.T_scene_wall.rotation * Vector3d(-wall.length_m, 0, 0), {0, 0, high_m - low_m},
                         paint);
}

void RoomFurnishing::cover_around(const Wall& wall, const Opening& opening, const Paint& paint) {
  const double end_m = 0.5 * wall.length_m;
  const double left_m = opening.middle_m - 0.5 * opening.width_m;
  const double right_m = opening.middle_m + 0.5 * opening.width_m;
  // A pattern begins at the lower corner at +x, as for a whole wall.
  const auto part = [&](double from_m, double to_m, double low_m) {
    Paint shifted = paint;
    if (paint.repeat_m > 0) shifted.offset += Vector2d(end_m - to_m, low_m) / paint.repeat_m;
    builder_.add_rectangle(wall.T_scene_wall * Vector3d(to_m, 0, low_m),
                           wall.T_scene_wall.rotation * Vector3d(from_m - to_m, 0, 0),
                           {0, 0, wall.height_m - low_m}, shifted);
  };
  part(right_m, end_m, 0);
  part(-end_m, left_m, 0);
  part(left_m, right_m, opening.height_m);
}

void RoomFurnishing::skirting(const Wall& wall) {
  builder_.add_box(placed(wall.T_scene_wall, {0, 0.01, 0}), {wall.length_m, 0.02, 0.09},
                   {.texture = textures_.dark_wood, .repeat_m = 0.6});
}

void RoomFurnishing::door_frame(const Wall& wall, const Opening& opening, double thickness_m) {
  constexpr double kPost_m = 0.06;
  constexpr double kProud_m = 0.02;  // protrusion from the wall, on both sides
  const Paint paint{.texture = textures_.dark_wood, .repeat_m = 0.6};
  const double depth_m = thickness_m + 2 * kProud_m;
  for (const double side : {-0.5, 0.5}) {
    const double x = opening.middle_m + side * (opening.width_m + kPost_m);
    builder_.add_box(placed(wall.T_scene_wall, {x, -0.5 * thickness_m, 0}),
                     {kPost_m, depth_m, opening.height_m}, paint);
  }
  builder_.add_box(placed(wall.T_scene_wall, {opening.middle_m, -0.5 * thickness_m, opening.height_m}),
                   {opening.width_m + 2 * kPost_m, depth_m, kPost_m}, paint);
}

void RoomFurnishing::floor_and_ceiling(const SE3& T_scene_room, const Vector2d& half_m, double height_m) {
  const Vector3d x = T_scene_room.rotation * Vector3d(2 * half_m.x(), 0, 0);
  const Vector3d y = T_scene_room.rotation * Vector3d(0, 2 * half_m.y(), 0);
  const Vector3d corner = T_scene_room * Vector3d(-half_m.x(), -half_m.y(), 0);
  builder_.add_rectangle(corner, x, y, {.texture = textures_.floor, .repeat_m = 1.1});
  builder_.add_rectangle(corner + Vector3d(0, 0, height_m), y, x,
                         {.texture = textures_.ceiling, .repeat_m = 1.6});
}

void RoomFurnishing::seating_area(const SE3& T_scene_room) {
  const double turn = random_.uniform(-0.3, 0.3);
  builder_.add_box(placed(T_scene_room, {0, 0, 0.001}, turn), {2.2, 1.6, 0.012},
                   {.texture = textures_.rug, .repeat_m = 0});
  furnisher_.coffee_table(
      placed(T_scene_room, {random_.uniform(-0.3, 0.3), random_.uniform(-0.2, 0.2), 0.013}, turn + 0.2));
}

void RoomFurnishing::lamp_shade(const SE3& T) {
  builder_.add_frustum(T, 0.2, 0.08, 0.14,
                       {.texture = textures_.fabrics[1], .repeat_m = 0.3, .brightness = 1.3F});
}

void RoomFurnishing::books_wall(const Wall& w) {
  cover(w, 0, w.height_m, {.texture = textures_.wallpaper, .repeat_m = 1.1});
  skirting(w);
  const double shelf_m = random_.uniform(1.5, 1.9);
  const double x = 0.5 * (w.length_m - shelf_m) - 0.25;
  furnisher_.bookshelf(placed(w.T_scene_wall, {x, 0.17, 0}), shelf_m, random_.uniform(1.85, 2.15));
  furnisher_.cabinet(placed(w.T_scene_wall, {x - 0.5 * shelf_m - 0.75, 0.24, 0}), 1.2, 0.8);
  furnisher_.picture(placed(w.T_scene_wall, {x - 0.5 * shelf_m - 0.75, 0, 1.6}), 0.8, 0.6);
  furnisher_.picture(placed(w.T_scene_wall, {0.4 - 0.5 * w.length_m, 0, 1.75}), 0.4, 0.5);
}

void RoomFurnishing::desk_wall(const Wall& w) {
  cover(w, 0, w.height_m, {.texture = textures_.bricks, .repeat_m = 1.0});
  skirting(w);
  const double x = random_.uniform(-0.5, 0.2);
  furnisher_.desk(placed(w.T_scene_wall, {x, 0.42, 0}));
  furnisher_.chair(placed(w.T_scene_wall, {x - 0.1, 1.02, 0}, std::numbers::pi + random_.uniform(-0.3, 0.3)));
  builder_.add_box(placed(w.T_scene_wall, {x, 0.015, 1.25}), {1.3, 0.03, 0.75},
                   {.texture = textures_.fabrics[0], .repeat_m = 0.4});
  for (int i = 0; i < 5; ++i) {  // sheets and pictures on the pin board
    furnisher_.picture(placed(w.T_scene_wall, {x - 0.5 + 0.25 * i, 0.03, random_.uniform(1.5, 1.75)}), 0.2,
                       random_.uniform(0.22, 0.36));
  }
  for (int i = 0; i < 3; ++i) {
    furnisher_.carton(
        placed(w.T_scene_wall, {0.5 * w.length_m - 0.45, 0.4, 0.3 * i}, random_.uniform(-0.2, 0.2)),
        {0.5, 0.4, 0.29});
  }
  furnisher_.picture(placed(w.T_scene_wall, {0.5 * w.length_m - 0.6, 0, 1.6}), 0.6, 0.75);
}

void RoomFurnishing::plain_wall(const Wall& w) {
  cover(w, 0, w.height_m, {.texture = textures_.plain, .repeat_m = 1});
  skirting(w);
  furnisher_.plant(placed(w.T_scene_wall, {0.5 * w.length_m - 0.42, 0.42, 0}), random_.uniform(0.8, 1.2));
  furnisher_.door(placed(w.T_scene_wall, {0.8 - 0.5 * w.length_m, 0, 0}));
  furnisher_.chair(placed(w.T_scene_wall, {0.5 * w.length_m - 1.2, 0.45, 0}, random_.uniform(-0.4, 0.4)));
  furnisher_.picture(placed(w.T_scene_wall, {0.5 * w.length_m - 0.5, 0, 1.6}), 0.5, 0.7);
}

void RoomFurnishing::sofa_wall(const Wall& w) {
  constexpr double kWainscot_m = 1.05;
  cover(w, 0, kWainscot_m, {.texture = textures_.tiles, .repeat_m = 1.0});
  cover(w, kWainscot_m, w.height_m, {.texture = textures_.plaster, .repeat_m = 1.3});
  skirting(w);
  const double x = random_.uniform(-0.4, 0.0);
  furnisher_.sofa(placed(w.T_scene_wall, {x, 0.5, 0}));
  furnisher_.window(placed(w.T_scene_wall, {x, 0, 1.2}));
  furnisher_.shelf_of_jars(placed(w.T_scene_wall, {0.5 * w.length_m - 0.65, 0, 1.3}), 6, 3);
  furnisher_.cabinet(placed(w.T_scene_wall, {0.5 * w.length_m - 0.6, 0.24, 0}), 0.9, 0.6);
}

void RoomFurnishing::entrance_wall(const Wall& w, const Opening& opening) {
  cover_around(w, opening, {.texture = textures_.plaster, .repeat_m = 1.2});
  const double left_m = opening.middle_m - 0.5 * opening.width_m;
  const double right_m = opening.middle_m + 0.5 * opening.width_m;
  const double left_middle_m = 0.5 * (left_m - 0.5 * w.length_m);
  furnisher_.cabinet(placed(w.T_scene_wall, {left_middle_m, 0.24, 0}), 1.2, random_.uniform(0.7, 0.9));
  furnisher_.picture(placed(w.T_scene_wall, {left_middle_m + random_.uniform(-0.2, 0.2), 0, 1.75}),
                     random_.uniform(0.6, 0.9), 0.6);
  furnisher_.plant(placed(w.T_scene_wall, {0.5 * w.length_m - 0.42, 0.42, 0}), random_.uniform(0.8, 1.2));
  furnisher_.chair(placed(w.T_scene_wall, {right_m + 0.55, 0.45, 0}, random_.uniform(-0.4, 0.4)));
  furnisher_.picture(placed(w.T_scene_wall, {right_m + random_.uniform(0.5, 0.9), 0, 1.7}), 0.5, 0.6);
}

}  // namespace fusebench::simulator::scene
