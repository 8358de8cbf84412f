// The rigid transform that brings one list of poses closest to another.
#pragma once

#include <span>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"

namespace fusebench::trajectory_error {

/// T_reference_estimate from poses that belong together, orientation included: the rotation that minimises
/// sum |R_reference_i - R R_estimate_i|^2 (Frobenius), then the translation that is best for the positions.
/// Unlike an alignment of positions alone (align_positions) it is well defined for a camera that hardly
/// moves, where the noise of positions would turn the world by degrees. Error data_corrupt: no poses, or
/// orientations that contradict each other so much that they have no mean.
[[nodiscard]] Result<SE3> align_poses(std::span<const SE3> reference, std::span<const SE3> estimate);

}  // namespace fusebench::trajectory_error
