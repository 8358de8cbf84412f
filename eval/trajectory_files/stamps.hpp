// Stamps of trajectories, as integers and as the doubles that scripts compare.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::trajectory_files {

/// The stamps of a trajectory, in order.
[[nodiscard]] inline std::vector<std::int64_t> stamps_of(const Trajectory& trajectory) {
  std::vector<std::int64_t> stamps;
  stamps.reserve(trajectory.size());
  for (const StampedPose& pose : trajectory) stamps.push_back(pose.timestamp_ns);
  return stamps;
}

/// Limited to half the range of the result, as stamps are; 0 of NaN.
[[nodiscard]] inline std::int64_t nanoseconds(double seconds) {
  constexpr std::int64_t kMost_ns = std::numeric_limits<std::int64_t>::max() / 2;
  constexpr double kMost_s = 4.6e9;
  if (std::isnan(seconds)) return 0;
  if (std::abs(seconds) > kMost_s) return seconds < 0 ? -kMost_ns : kMost_ns;
  return static_cast<std::int64_t>(std::llround(seconds * 1e9));
}

/// The double nearest to the decimal stamp, as if its text had been read. At today's epochs that is a grid of
/// a quarter of a microsecond, which decides what lies just at a limit.
[[nodiscard]] inline double stamp_seconds(std::int64_t stamp_ns) {
  return static_cast<double>(static_cast<long double>(stamp_ns) / 1e9L);
}

}  // namespace fusebench::trajectory_files
