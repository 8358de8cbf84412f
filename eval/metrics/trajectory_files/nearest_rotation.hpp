// Matrices that are rotations but for the digits they were written with.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::trajectory_files {

/// The rotation nearest to a matrix, and by how much the matrix is none.
struct NearestRotation {
  Matrix3d R;
  double deviation = 0;  ///< largest entry of R^T R - I; 1 of a reflection or a singular matrix
};
[[nodiscard]] NearestRotation nearest_rotation(const Matrix3d& matrix);

}  // namespace fusebench::trajectory_files
