// Transforms the state of the filter to another world frame, after a correction of all poses.
#pragma once

#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::filter {

/// The state in the new world frame, x_new = T_new_old * x_old: poses, velocity, gravity and the IMU axes are
/// transformed; everything else is unchanged.
[[nodiscard]] FilterState moved(const FilterState& state, const SE3& T_new_old);

/// As moved(FilterState); the covariance is rotated to the new frame.
[[nodiscard]] GaussianState moved(const GaussianState& state, const SE3& T_new_old);

}  // namespace fusebench::filter
