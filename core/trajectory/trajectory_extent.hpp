// How far a trajectory extends.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::trajectory {

/// Length of the diagonal of the box around the positions [m]; 0 of no pose.
[[nodiscard]] double extent_m(const Trajectory& trajectory);

/// The poses from the first to the last stamp of another trajectory; none if that is empty.
[[nodiscard]] Trajectory within_time_of(const Trajectory& trajectory, const Trajectory& other);

}  // namespace fusebench::trajectory
