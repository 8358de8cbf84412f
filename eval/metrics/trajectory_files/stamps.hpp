// Stamps of trajectories, as integers and as the doubles that scripts compare.
#pragma once

#include <algorithm>
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

/// Rounded to the nearest. What 64 bits do not hold, infinity included, becomes the nearest that they hold.
[[nodiscard]] inline std::int64_t nanoseconds(double seconds) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  const double wanted = seconds * 1e9;
  if (wanted >= static_cast<double>(kMost)) return kMost;
  if (wanted <= -static_cast<double>(kMost)) return -kMost;
  return std::llround(wanted);
}

/// a + b, at most +-(2^63 - 1), so that it has a negative.
[[nodiscard]] inline std::int64_t clamped_sum(std::int64_t a, std::int64_t b) {
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  std::int64_t sum = 0;
  if (!__builtin_add_overflow(a, b, &sum)) return std::max(sum, -kMost);
  return b > 0 ? kMost : -kMost;
}

/// The double nearest to the decimal stamp, as if its text had been read. At today's epochs that is a grid of
/// a quarter of a microsecond, which decides what lies just at a limit.
[[nodiscard]] inline double stamp_seconds(std::int64_t stamp_ns) {
  return static_cast<double>(static_cast<long double>(stamp_ns) / 1e9L);
}

}  // namespace fusebench::trajectory_files
