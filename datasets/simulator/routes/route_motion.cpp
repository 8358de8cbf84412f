#include "datasets/simulator/routes/route_motion.hpp"

#include <cmath>

#include "core/base/error.hpp"
#include "datasets/simulator/motion/motion_path.hpp"
#include "datasets/simulator/routes/preset_routes.hpp"

namespace fusebench::simulator::routes {

namespace {

// Approximate amplitude of the sway about the route per axis; peaks are up to twice as large.
constexpr double kSway_mps = 0.05;
constexpr double kSway_radps = 0.08;

// Share of the plan in the peak speeds; the rest is for sway and tremor.
constexpr double kPlannedSpeed = 0.8;
constexpr double kPlannedRate = 0.75;

constexpr double kWalkSpacing_s = 0.3;    // rounds the corners of a walk over about a second
constexpr double kShakeSpacing_s = 0.06;  // a hand reverses its rotation within about 0.2 s

RoutePlan plan_of(motion::MotionPreset preset, const RouteRequest& request, double end_s) {
  using motion::MotionPreset;
  switch (preset) {
    case MotionPreset::loop_room:
      return loop_room_route(request);
    case MotionPreset::loop_flat:
      return loop_flat_route(request);
    case MotionPreset::corridor:
      return corridor_route(request);
    case MotionPreset::shake_revisit:
      return shake_revisit_route(request, end_s);
    case MotionPreset::twin_rooms:
      return twin_rooms_route(request);
    default:
      return no_loop_route(request);
  }
}

}  // namespace

synthetic_imu::PoseSpline route_motion(motion::MotionPreset preset, const motion::MotionOptions& options,
                                       const motion::MotionSpan& span, const Eigen::AlignedBox3d& free_space,
                                       std::uint64_t seed) {
  check(motion::follows_route(preset), "a preset with a route");
  const double length_s = seconds_between(span.begin_ns, span.last_frame_ns + motion::MotionSpan::kTail_ns);
  const bool shakes = preset == motion::MotionPreset::shake_revisit;
  const RouteRequest request{{kPlannedSpeed * options.peak_speed_mps, kPlannedRate * options.peak_rate_radps},
                             options.mean_pitch_rad,
                             free_space,
                             seed};
  const RoutePlan plan = plan_of(preset, request, length_s);
  const synthetic_imu::PoseSpline route = smooth_route(plan, shakes ? kShakeSpacing_s : kWalkSpacing_s);
  const motion::HandPath hand(options, seed, Vector3d::Ones(), length_s);
  motion::PathClock clock;
  clock.still_until_s = seconds_between(span.begin_ns, span.first_frame_ns);
  if (options.from_rest) {
    clock.still_until_s += options.rest_s;
    clock.start_s = options.start_s;
  }
  const auto pose = [&](double path_s) {
    const SE3 T_world_route = route.evaluate(std::llround(1e9 * path_s)).T_world_body;
    const Vector3d sway = kSway_radps * hand.angles(path_s) + options.tremor_rad * hand.angle_tremor(path_s);
    // Yaw, pitch and roll of the hand, about the camera's down, right and forward axes.
    const Quaterniond turned = T_world_route.rotation * so3_exp({sway[1], -sway[0], sway[2]});
    return SE3{turned, T_world_route.translation + kSway_mps * hand.position(path_s) +
                           options.tremor_m * hand.tremor(path_s)};
  };
  return motion::spline_along(pose, clock, span);
}

}  // namespace fusebench::simulator::routes
