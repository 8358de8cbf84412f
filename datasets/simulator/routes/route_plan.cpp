#include "datasets/simulator/routes/route_plan.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "datasets/simulator/motion/motion_heading.hpp"

namespace fusebench::simulator::routes {

void RoutePlan::move_to(const Vector3d& position_world_m, double heading_rad, double pitch_rad) {
  const double turn_rad = std::remainder(heading_rad - last().heading_rad, 2 * std::numbers::pi);
  const double angle_rad = std::max(std::abs(turn_rad), std::abs(pitch_rad - last().pitch_rad));
  const double distance_m = (position_world_m - last().position_world_m).norm();
  const double duration_s = std::max(distance_m / speeds_.speed_mps, angle_rad / speeds_.rate_radps);
  swing_to(position_world_m, last().heading_rad + turn_rad, pitch_rad, duration_s);
}

void RoutePlan::swing_to(const Vector3d& position_world_m, double heading_rad, double pitch_rad,
                         double duration_s) {
  poses_.push_back({last().time_s + duration_s, position_world_m, heading_rad, pitch_rad});
}

void RoutePlan::stay(double duration_s) {
  swing_to(last().position_world_m, last().heading_rad, last().pitch_rad, duration_s);
}

KeyPose RoutePlan::at(double time_s) const {
  const auto next = std::ranges::upper_bound(poses_, time_s, {}, &KeyPose::time_s);
  if (next == poses_.begin()) return poses_.front();
  if (next == poses_.end()) return poses_.back();
  const KeyPose& a = *std::prev(next);
  const KeyPose& b = *next;
  const double share = (time_s - a.time_s) / (b.time_s - a.time_s);
  return {time_s, a.position_world_m + share * (b.position_world_m - a.position_world_m),
          std::lerp(a.heading_rad, b.heading_rad, share), std::lerp(a.pitch_rad, b.pitch_rad, share)};
}

synthetic_imu::PoseSpline smooth_route(const RoutePlan& plan, double spacing_s) {
  const auto nanoseconds = [](double seconds) {
    return static_cast<std::int64_t>(std::llround(1e9 * seconds));
  };
  const double rest_s = 3 * spacing_s;
  synthetic_imu::PoseSpline spline(nanoseconds(-rest_s), nanoseconds(plan.last().time_s + rest_s),
                                   nanoseconds(spacing_s));
  for (std::size_t i = 0; i < spline.position_world_m.size(); ++i) {
    const KeyPose pose = plan.at(seconds_between(0, spline.control_time_ns(i)));
    spline.position_world_m[i] = pose.position_world_m;
    spline.rotation_world_body[i] = motion::looking(pose.heading_rad, pose.pitch_rad, 0);
  }
  return spline;
}

}  // namespace fusebench::simulator::routes
