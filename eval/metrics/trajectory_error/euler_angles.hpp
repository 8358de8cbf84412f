// Orientations as roll, pitch and yaw.
#pragma once

#include <cmath>

#include "core/base/geometry.hpp"

namespace fusebench::trajectory_error {

/// Angles about the fixed axes x, y, z, turned about in that order: R = Rz(yaw) Ry(pitch) Rx(roll). Radians,
/// in the order of the axes.
[[nodiscard]] inline Vector3d roll_pitch_yaw_rad(const Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace fusebench::trajectory_error
