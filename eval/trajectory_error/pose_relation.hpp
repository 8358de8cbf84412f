// What is compared of two poses or of two motions, with evo's names and definitions.
#pragma once

#include <optional>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"

namespace fusebench::trajectory_error {

enum class PoseRelation {
  translation,           ///< |t| of the difference; of absolute errors the distance of positions
  point_distance,        ///< absolute: the distance of positions; relative: | |q_i-q_j| - |p_i-p_j| |
  distance_error_ratio,  ///< relative only: point_distance in percent of the reference's
  rotation_part,         ///< Frobenius norm of R - I
  angle_rad,
  angle_deg,
  full,  ///< Frobenius norm of E - I, metres and rotations together: without a unit
};

/// evo's spelling: trans_part, point_distance, point_distance_error_ratio, rot_part, angle_rad, angle_deg,
/// full.
[[nodiscard]] std::string_view to_string(PoseRelation relation);
[[nodiscard]] Result<PoseRelation> parse_pose_relation(std::string_view text);

/// "m", "%", "rad", "deg", or "" of rotation_part and full.
[[nodiscard]] std::string_view unit_of(PoseRelation relation);

/// Of one pose of each side. distance_error_ratio has none (check() fails).
[[nodiscard]] double absolute_error(PoseRelation relation, const SE3& reference, const SE3& estimate);

/// A motion: from one pose to another of the same trajectory.
struct Motion {
  SE3 from;
  SE3 to;
};

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) for reference Q and estimate P. Nothing for a ratio of a reference that
/// did not move.
[[nodiscard]] std::optional<double> relative_error(PoseRelation relation, const Motion& reference,
                                                   const Motion& estimate);

}  // namespace fusebench::trajectory_error
