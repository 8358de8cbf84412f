// How exactly the coordinates of a trajectory are given.
#pragma once

#include <span>

#include "core/base/geometry.hpp"

namespace fusebench::trajectory_files {

/// Half a unit of the last decimal that any coordinate has, of at least three decimals and at most 17, but at
/// least 16 roundings of a double (3.6e-15 of the largest coordinate), which transforms of poses take:
///
///   max(10^-d / 2, 16 eps max |coordinate|)
///
/// Coordinates that differ by no more may be equal. Numbers of files have a fixed count of decimals (TUM's
/// ground truth four), those of an estimator in memory have all that a double has. Fewer than three decimals
/// are taken as exact to the millimetre.
[[nodiscard]] double coordinate_rounding(std::span<const Vector3d> positions);

}  // namespace fusebench::trajectory_files
