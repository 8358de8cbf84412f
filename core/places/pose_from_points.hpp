// The pose of a camera from points whose place is known and where they are seen, some of them wrongly.
//
// Three points give a pose (P3P) in RANSAC; Gauss-Newton steps over all that agree refine it, with weights
// that bound the pull of the worst. Points in metres of any frame `a`, pixels of level 0.
// Errors: none; points that agree on nothing give no value.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::places {

/// A point and where it is seen.
struct SeenPoint {
  Vector3d point_a = Vector3d::Zero();
  Vector2d pixel_px = Vector2d::Zero();
  double scale = 1;  ///< pixels that pixel_px may be wrong by, in relation to the others
};

struct PoseFromPoints {
  SE3 T_a_camera;
  std::vector<std::size_t> inliers;  ///< indices, rising
  double rms_px = 0;                 ///< of the inliers, each divided by its scale
  /// Of rotation (on the right, rad) and position (frame a, metres), as the inliers scatter.
  Matrix6d covariance = Matrix6d::Zero();
};

/// The pose that most points agree with. Depends on the points and their order alone: the random draws are
/// the same in each call.
[[nodiscard]] std::optional<PoseFromPoints> pose_from_points(std::span<const SeenPoint> seen,
                                                             const PinholeCamera& camera);

}  // namespace fusebench::places
