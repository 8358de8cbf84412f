// The routes of the presets that follow one, through their scenes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/simulator/routes/route_plan.hpp"

namespace fusebench::simulator::routes {

/// What a route is planned for.
struct RouteRequest {
  RouteSpeeds speeds;
  double pitch_rad = 0;            ///< the mean one
  Eigen::AlignedBox3d free_space;  ///< of the preset's scene
  std::uint64_t seed = 1;
};

/// Twice along the walls of the room that free_space is the middle of, looking outward; every lap ends where
/// the first one began, within 0.1 m.
[[nodiscard]] RoutePlan loop_room_route(const RouteRequest& request);
/// In a scene::make_flat(): along the corridor, round in every room, back along the corridor to the beginning
/// and its direction of view.
[[nodiscard]] RoutePlan loop_flat_route(const RouteRequest& request);
/// In a scene::make_corridor(): 25 m out, a turn at the end, 25 m back on the other side with a view of the
/// same wall, and a turn to the first direction of view.
[[nodiscard]] RoutePlan corridor_route(const RouteRequest& request);
/// In an office: 4 s of one view, 2 s of shaking through it to both sides and back, and so on to the end_s.
[[nodiscard]] RoutePlan shake_revisit_route(const RouteRequest& request, double end_s);
/// In a scene::make_twin_rooms(): round in the first room, through the corridor, the same round in the other.
[[nodiscard]] RoutePlan twin_rooms_route(const RouteRequest& request);
/// In a scene::make_gallery(): along its furnished wall.
[[nodiscard]] RoutePlan no_loop_route(const RouteRequest& request);

}  // namespace fusebench::simulator::routes
