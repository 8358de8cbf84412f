// The rigid transform that brings one set of points closest to another.
#pragma once

#include <span>

#include "core/error.hpp"
#include "core/geometry.hpp"

namespace fusebench {

/// Least-squares T_reference_estimate: minimises sum |reference_i - T * estimate_i|^2 (Horn 1987; Umeyama
/// 1991 with scale 1). Both in metres, of equal size.
///
/// Error data_corrupt: fewer than three points, or points of either set on a line (the second singular value
/// of the cross-covariance is below 1e-9 of the first): the rotation about the line is then arbitrary.
[[nodiscard]] Result<SE3> align_se3(std::span<const Vector3d> reference, std::span<const Vector3d> estimate);

}  // namespace fusebench
