// Routes of the presets through their scenes.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>

#include "datasets/simulator/motion/motion.hpp"
#include "datasets/simulator/routes/route_plan.hpp"

namespace fusebench::simulator::routes {

/// Input of the planning of a route.
struct RouteRequest {
  RouteSpeeds speeds;
  double pitch_rad = 0;            ///< mean pitch
  Eigen::AlignedBox3d free_space;  ///< of the preset's scene
  std::uint64_t seed = 1;
};

/// Two laps along the walls of the room around free_space, looking outwards. Each lap ends within 0.1 m of
/// the start of the first.
[[nodiscard]] RoutePlan loop_room_route(const RouteRequest& request);
/// In a scene::make_flat(): along the corridor, around each room, and back along the corridor to the first
/// pose.
[[nodiscard]] RoutePlan loop_flat_route(const RouteRequest& request);
/// In a scene::make_corridor(): 25 m forward, a turn, 25 m back on the other side with a view of the same
/// wall, and a turn to the first viewing direction.
[[nodiscard]] RoutePlan corridor_route(const RouteRequest& request);
/// In an office: 4 s of one view, 2 s of shaking to both sides and back, repeated until end_s.
[[nodiscard]] RoutePlan shake_revisit_route(const RouteRequest& request, double end_s);
/// In a scene::make_twin_rooms(): around the first room, through the corridor, the same path in the other
/// room.
[[nodiscard]] RoutePlan twin_rooms_route(const RouteRequest& request);
/// In a scene::make_gallery(): along its furnished wall.
[[nodiscard]] RoutePlan no_loop_route(const RouteRequest& request);

}  // namespace fusebench::simulator::routes
