// Moves points onto a surface: ICP against exact distances to triangles, trimmed, without scale.
#pragma once

#include <cstddef>
#include <span>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/mesh_error/triangle_tree.hpp"

namespace fusebench::mesh_error {

struct RegistrationOptions {
  /// Of the points, those nearest to the surface, that count in a step: what has no counterpart in the ground
  /// truth must not pull.
  double kept = 0.9;
  int max_steps = 100;
  double converged_m = 1e-7;  ///< a step that moves the points by less (rms) is the last
};

struct RegistrationResult {
  SE3 T_surface_points;
  int steps = 0;
  bool converged = false;  ///< false: max_steps were not enough
  double kept_rms_m = 0;   ///< distance of the points that counted, before the last step
  /// Directions in which the points can slide along the surface, of six (a plane has three): the transform
  /// is left alone in them.
  int free_directions = 0;
};

/// Gauss-Newton over distances to the surface, from an initial transform (after Chetverikov et al., "The
/// trimmed iterative closest point algorithm", ICPR 2002, with each point's distance linearised along the
/// line to its nearest surface point as by Chen and Medioni, 1992).
///
/// Errors: usage for a share that is not in (0, 1]; data_corrupt if fewer than six points are kept.
[[nodiscard]] Result<RegistrationResult> register_points(std::span<const Vector3d> points,
                                                         const TriangleTree& surface,
                                                         const SE3& T_surface_points,
                                                         const RegistrationOptions& options,
                                                         const Workers& workers);

}  // namespace fusebench::mesh_error
