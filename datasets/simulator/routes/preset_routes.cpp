#include "datasets/simulator/routes/preset_routes.hpp"

#include <array>
#include <numbers>

#include "datasets/simulator/random/random_numbers.hpp"
#include "datasets/simulator/scene/corridor.hpp"
#include "datasets/simulator/scene/flat.hpp"
#include "datasets/simulator/scene/gallery.hpp"

namespace fusebench::simulator::routes {

namespace {

constexpr double kQuarter_rad = 0.5 * std::numbers::pi;
constexpr double kHalf_rad = std::numbers::pi;
constexpr std::uint64_t kPurpose = 0x726F757465ULL;  // key of an independent random stream

random::RandomSequence random_of(const RouteRequest& request) {
  return random::RandomSequence(random::mix_key(request.seed, kPurpose));
}

double hand_height_m(random::RandomSequence& random) { return random.uniform(1.35, 1.5); }

/// A rectangular ring within a room. Sides are numbered counter-clockwise from the one at -y.
struct Ring {
  Vector2d middle_m{0, 0};
  Vector2d half_m{0, 0};
  double height_m = 0;

  /// The middle of a side, or with corner = +-1 its end in that direction of numbering.
  [[nodiscard]] Vector3d at(int side, int corner = 0) const {
    const double angle_rad = outward_rad(side);
    const Vector2d outward(std::round(std::cos(angle_rad)), std::round(std::sin(angle_rad)));
    const Vector2d along(-outward.y(), outward.x());
    const Vector2d place = middle_m + half_m.cwiseProduct(outward + corner * along);
    return {place.x(), place.y(), height_m};
  }
  [[nodiscard]] static double outward_rad(int side) { return kQuarter_rad * (side - 1); }
};

/// One round from the middle of a side, or over a part of its four sides, looking outwards.
void add_lap(RoutePlan& plan, const Ring& ring, int first_side, int direction, double pitch_rad,
             int sides = 4) {
  for (int i = 0; i < sides; ++i) {
    const int side = first_side + direction * i;
    const double corner_rad = Ring::outward_rad(side) + direction * 0.5 * kQuarter_rad;
    plan.move_to(ring.at(side, direction), corner_rad, pitch_rad);
    plan.move_to(ring.at(side + direction), Ring::outward_rad(side + direction), pitch_rad);
  }
}

/// Ring in a room of a flat; side 0 is at the door.
Ring room_ring(int room, double height_m, random::RandomSequence& random) {
  constexpr double kHalf_m = 1.15;
  const double size = random.uniform(0.93, 1.07);
  return {{room * scene::FlatShape::kUnit_m, scene::FlatShape::kRoomMiddle_m},
          {size * kHalf_m, size * kHalf_m},
          height_m};
}

Vector3d before_door(int room, double height_m) {
  return {room * scene::FlatShape::kUnit_m, -0.5 * scene::FlatShape::kCorridorWidth_m, height_m};
}

int any_direction(random::RandomSequence& random) { return random.below(2) == 0 ? 1 : -1; }

}  // namespace

RoutePlan loop_room_route(const RouteRequest& request) {
  random::RandomSequence random = random_of(request);
  const Vector3d middle = request.free_space.center();
  Ring ring{middle.head<2>(), 0.5 * request.free_space.sizes().head<2>(), hand_height_m(random)};
  const int side = random.below(4);
  const int direction = any_direction(random);
  RoutePlan plan(request.speeds, {0, ring.at(side), Ring::outward_rad(side), request.pitch_rad});
  add_lap(plan, ring, side, direction, request.pitch_rad);
  ring.half_m.array() -= random.uniform(0.03, 0.08);
  ring.height_m += random.uniform(-0.05, 0.05);
  add_lap(plan, ring, side, direction, request.pitch_rad);
  return plan;
}

RoutePlan loop_flat_route(const RouteRequest& request) {
  constexpr double kOblique_rad = radians(50.0);
  constexpr double kStart_m = -1.7;
  random::RandomSequence random = random_of(request);
  const double height_m = hand_height_m(random);
  const double pitch_rad = request.pitch_rad;
  const Vector3d start(kStart_m, before_door(0, height_m).y(), height_m);
  RoutePlan plan(request.speeds, {0, start, kOblique_rad, pitch_rad});
  for (int room = 0; room < scene::kFlatRooms; ++room) {
    const Ring ring = room_ring(room, height_m, random);
    Vector3d ahead = before_door(room, height_m);
    ahead.x() -= 0.8;
    if (room > 0) plan.move_to(ahead, kOblique_rad, pitch_rad);
    plan.move_to(before_door(room, height_m), kQuarter_rad, pitch_rad);
    plan.move_to(ring.at(0), kQuarter_rad, pitch_rad);
    add_lap(plan, ring, 0, any_direction(random), pitch_rad);
    plan.move_to(before_door(room, height_m), -kQuarter_rad, pitch_rad);
  }
  plan.move_to(before_door(scene::kFlatRooms - 1, height_m), kHalf_rad - kOblique_rad, pitch_rad);
  plan.move_to(start, kHalf_rad - kOblique_rad, pitch_rad);
  plan.move_to(start, kOblique_rad, pitch_rad);
  return plan;
}

RoutePlan corridor_route(const RouteRequest& request) {
  constexpr double kOut_m = 25;
  constexpr double kOblique_rad = radians(45.0);
  constexpr double kStep_m = 2.5;
  random::RandomSequence random = random_of(request);
  const double side = any_direction(random);
  const double height_m = hand_height_m(random);
  const double pitch_rad = request.pitch_rad;
  const Vector3d start(0.5 * (scene::CorridorShape::kLength_m - kOut_m), -0.2 * side, height_m);
  RoutePlan plan(request.speeds, {0, start, side * kOblique_rad, pitch_rad});
  const auto wander = [&](double from_m, double direction, double heading_rad) {
    for (double gone_m = kStep_m; gone_m <= kOut_m; gone_m += kStep_m) {
      const Vector3d place(start.x() + from_m + direction * gone_m, random.uniform(-0.25, 0.25), height_m);
      plan.move_to(place, heading_rad + random.uniform(-0.1, 0.1), pitch_rad);
    }
  };
  wander(0, 1, side * kOblique_rad);
  const Vector3d end = plan.last().position_world_m;
  plan.move_to(end, -side * kQuarter_rad, pitch_rad);  // past the end wall
  plan.move_to(end, side * (kHalf_rad - kOblique_rad), pitch_rad);
  wander(kOut_m, -1, side * (kHalf_rad - kOblique_rad));
  plan.move_to(start, side * kOblique_rad, pitch_rad);
  plan.stay(2);
  return plan;
}

RoutePlan shake_revisit_route(const RouteRequest& request, double end_s) {
  constexpr double kQuiet_s = 4;
  constexpr double kShaking_s = 2;
  constexpr double kReach_m = 0.12;
  random::RandomSequence random = random_of(request);
  const Vector3d box_m = request.free_space.sizes();
  const Vector3d place =
      request.free_space.min() +
      box_m.cwiseProduct(Vector3d(random.uniform(0.3, 0.45), random.uniform(0.3, 0.7), 0.5));
  const double heading_rad = random.uniform(-0.2, 0.2);
  RoutePlan plan(request.speeds, {0, place, heading_rad, request.pitch_rad});
  while (plan.last().time_s < end_s) {
    plan.stay(kQuiet_s);
    const double side = any_direction(random);
    // To one side, to the other, to the first again, and back.
    const std::array<double, 4> headings_rad = {heading_rad + side * radians(random.uniform(95, 115)),
                                                heading_rad - side * radians(random.uniform(80, 100)),
                                                heading_rad + side * radians(random.uniform(85, 105)),
                                                heading_rad};
    double whole_rad = 0;
    for (std::size_t i = 0; i < 4; ++i)
      whole_rad += std::abs(headings_rad[i] - (i == 0 ? heading_rad : headings_rad[i - 1]));
    for (std::size_t i = 0; i < 4; ++i) {
      const bool back = i == 3;
      const double share = std::abs(headings_rad[i] - plan.last().heading_rad) / whole_rad;
      const Vector3d aside(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.5, 0.5));
      plan.swing_to(back ? place : Vector3d(place + kReach_m * aside), headings_rad[i],
                    request.pitch_rad + (back ? 0 : random.uniform(-0.15, 0.35)), share * kShaking_s);
    }
  }
  return plan;
}

RoutePlan twin_rooms_route(const RouteRequest& request) {
  random::RandomSequence random = random_of(request);
  const double height_m = hand_height_m(random);
  const double pitch_rad = request.pitch_rad;
  const Ring ring = room_ring(0, height_m, random);
  const int direction = any_direction(random);
  RoutePlan plan(request.speeds, {0, ring.at(2), Ring::outward_rad(2), pitch_rad});
  add_lap(plan, ring, 2, direction, pitch_rad, 6);
  plan.move_to(before_door(0, height_m), -kQuarter_rad, pitch_rad);
  plan.move_to(before_door(0, height_m), radians(-40.0), pitch_rad);
  plan.move_to(before_door(1, height_m), radians(40.0), pitch_rad);
  plan.move_to(before_door(1, height_m), kQuarter_rad, pitch_rad);
  Ring other = ring;
  other.middle_m.x() += scene::FlatShape::kUnit_m;
  plan.move_to(other.at(0), kQuarter_rad, pitch_rad);
  add_lap(plan, other, 0, direction, pitch_rad, 6);
  return plan;
}

RoutePlan no_loop_route(const RouteRequest& request) {
  constexpr double kEnds_m = 1.2;  // distance from the first end wall, and free view to the last one
  constexpr double kView_m = 2.8;
  constexpr double kStep_m = 2.0;
  constexpr double kHeading_rad = radians(66.0);
  random::RandomSequence random = random_of(request);
  const double height_m = hand_height_m(random);
  RoutePlan plan(request.speeds, {0, {kEnds_m, 0, height_m}, kHeading_rad, request.pitch_rad});
  for (double x = kEnds_m + kStep_m; x < scene::GalleryShape::kLength_m - kView_m; x += kStep_m) {
    plan.move_to({x, random.uniform(-0.15, 0.15), height_m + random.uniform(-0.05, 0.05)},
                 kHeading_rad + random.uniform(-0.12, 0.12), request.pitch_rad + random.uniform(-0.08, 0.08));
  }
  return plan;
}

}  // namespace fusebench::simulator::routes
