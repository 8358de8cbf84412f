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

/// T_a^-1 T_b. Positions far from the origin are subtracted first, which keeps their digits.
[[nodiscard]] inline SE3 motion_between(const SE3& T_world_a, const SE3& T_world_b) {
  const Quaterniond R_a_world = T_world_a.rotation.conjugate();
  return {(R_a_world * T_world_b.rotation).normalized(),
          R_a_world * Vector3d(T_world_b.translation - T_world_a.translation)};
}

/// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) for reference Q and estimate P. Nothing for a ratio of a reference that
/// did not move.
[[nodiscard]] std::optional<double> relative_error(PoseRelation relation, const Motion& reference,
                                                   const Motion& estimate);

}  // namespace fusebench::trajectory_error
