// Look-up in a trajectory, and the trajectory of another point.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/types.hpp"

namespace fusebench::trajectory {

/// Truth that pauses for longer than this (ten samples at 100 Hz) does not determine the motion in between.
inline constexpr std::int64_t kMaxTruthGap_ns = 100'000'000;

/// The pose at a time between two stamps, interpolated geodesically. Nothing if the time lies before the
/// first or after the last pose, or between two that are more than max_gap_ns apart. The stamps must
/// increase.
[[nodiscard]] std::optional<SE3> interpolate_pose(const Trajectory& trajectory, std::int64_t timestamp_ns,
                                                  std::int64_t max_gap_ns);

/// The poses of the point `point_m` of the body, with the body's axes.
[[nodiscard]] Trajectory of_point(Trajectory trajectory, const Vector3d& point_m);

/// The same poses by another clock: `offset_ns` is added to the stamps.
[[nodiscard]] Trajectory with_clock_offset(Trajectory trajectory, std::int64_t offset_ns);

}  // namespace fusebench::trajectory
