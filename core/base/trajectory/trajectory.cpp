#include "core/base/trajectory/trajectory.hpp"

#include <algorithm>

namespace fusebench::trajectory {

std::optional<SE3> interpolate_pose(const Trajectory& trajectory, std::int64_t timestamp_ns,
                                    std::int64_t max_gap_ns) {
  const auto after = std::ranges::lower_bound(trajectory, timestamp_ns, {}, &StampedPose::timestamp_ns);
  if (after == trajectory.end()) return std::nullopt;
  if (after->timestamp_ns == timestamp_ns) return after->T_world_camera;
  if (after == trajectory.begin()) return std::nullopt;
  const auto before = after - 1;
  if (after->timestamp_ns - before->timestamp_ns > max_gap_ns) return std::nullopt;
  const double fraction = seconds_between(before->timestamp_ns, timestamp_ns) /
                          seconds_between(before->timestamp_ns, after->timestamp_ns);
  return interpolate(before->T_world_camera, after->T_world_camera, fraction);
}

Trajectory of_point(Trajectory trajectory, const Vector3d& point_m) {
  for (StampedPose& pose : trajectory) pose.T_world_camera.translation = pose.T_world_camera * point_m;
  return trajectory;
}

Trajectory with_clock_offset(Trajectory trajectory, std::int64_t offset_ns) {
  for (StampedPose& pose : trajectory) pose.timestamp_ns += offset_ns;
  return trajectory;
}

}  // namespace fusebench::trajectory
