#include "core/trajectory/trajectory_extent.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>

namespace fusebench::trajectory {

double extent_m(const Trajectory& trajectory) {
  Eigen::AlignedBox3d box;
  for (const StampedPose& pose : trajectory) box.extend(pose.T_world_camera.translation);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

Trajectory within_time_of(const Trajectory& trajectory, const Trajectory& other) {
  Trajectory within;
  if (other.empty()) return within;
  const auto [first, last] = std::ranges::minmax(other, {}, &StampedPose::timestamp_ns);
  std::ranges::copy_if(trajectory, std::back_inserter(within), [&](const StampedPose& pose) {
    return pose.timestamp_ns >= first.timestamp_ns && pose.timestamp_ns <= last.timestamp_ns;
  });
  return within;
}

}  // namespace fusebench::trajectory
