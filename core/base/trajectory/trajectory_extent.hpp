// How far a trajectory extends.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::trajectory {

/// Length of the diagonal of the box around the positions [m]; 0 of no pose.
[[nodiscard]] double extent_m(const Trajectory& trajectory);

/// The poses from the first to the last stamp of another trajectory; none if that is empty.
[[nodiscard]] Trajectory within_time_of(const Trajectory& trajectory, const Trajectory& other);

/// Share [0, 1] of the time from the first to the last pose of `whole` in which `part` has poses. Time
/// between two poses of `part` counts if it is at most five times the median of these times. 1 if `whole` has
/// no duration. Stamps in any order.
[[nodiscard]] double covered_share_of_time(const Trajectory& whole, const Trajectory& part);

}  // namespace fusebench::trajectory
