// The filter in another world: what a correction of all poses does to it.
#pragma once

#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// The same state seen from another world, T_new_old: poses, velocity, gravity and what is expressed in the
/// axes of the world move; nothing else does.
[[nodiscard]] FilterState moved(const FilterState& state, const SE3& T_new_old);

/// With its covariance, whose tangent turns with the world.
[[nodiscard]] GaussianState moved(const GaussianState& state, const SE3& T_new_old);

}  // namespace fusebench::filter
