#include "core/base/trajectory/trajectory_extent.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <vector>

#include "core/base/upper_median.hpp"

namespace fusebench::trajectory {

namespace {

std::vector<double> sorted_stamps_ns(const Trajectory& trajectory) {
  std::vector<double> stamps_ns;
  stamps_ns.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) stamps_ns.push_back(static_cast<double>(pose.timestamp_ns));
  if (!std::ranges::is_sorted(stamps_ns)) std::ranges::sort(stamps_ns);
  return stamps_ns;
}

}  // namespace

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

double covered_share_of_time(const Trajectory& whole, const Trajectory& part) {
  constexpr double kLongestStep = 5;  // times the median
  const std::vector<double> whole_ns = sorted_stamps_ns(whole), part_ns = sorted_stamps_ns(part);
  if (whole_ns.empty() || whole_ns.front() == whole_ns.back()) return 1;
  if (part_ns.size() < 2) return 0;
  std::vector<double> steps_ns;
  steps_ns.reserve(part_ns.size());
  for (std::size_t i = 1; i < part_ns.size(); ++i) steps_ns.push_back(part_ns[i] - part_ns[i - 1]);
  const double longest_ns = kLongestStep * upper_median(steps_ns);
  double covered_ns = 0;
  for (std::size_t i = 1; i < part_ns.size(); ++i) {
    if (part_ns[i] - part_ns[i - 1] > longest_ns) continue;
    const double from_ns = std::max(whole_ns.front(), part_ns[i - 1]);
    const double to_ns = std::min(whole_ns.back(), part_ns[i]);
    covered_ns += std::max(0.0, to_ns - from_ns);
  }
  return covered_ns / (whole_ns.back() - whole_ns.front());
}

}  // namespace fusebench::trajectory
