// Pose of a camera from 3D points and their image positions with outliers.
//
// P3P in RANSAC, refined by Gauss-Newton over all inliers with robust weights. Points are in metres of any
// frame `a`, pixels of level 0. Errors: none; without a consistent pose there is no value.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/base/types.hpp"

namespace fusebench::places {

/// A point and its image position.
struct SeenPoint {
  Vector3d point_a = Vector3d::Zero();
  Vector2d pixel_px = Vector2d::Zero();
  double scale = 1;  ///< relative standard deviation of pixel_px
};

struct PoseFromPoints {
  SE3 T_a_camera;
  std::vector<std::size_t> inliers;  ///< indices, ascending
  double rms_px = 0;                 ///< of the inliers, each divided by its scale
  /// Rotation (on the right, rad) and position (frame a, metres), from the scatter of the inliers.
  Matrix6d covariance = Matrix6d::Zero();
};

/// The pose with the largest consensus. Depends on the points and their order only: the random draws are the
/// same in each call.
[[nodiscard]] std::optional<PoseFromPoints> pose_from_points(std::span<const SeenPoint> seen,
                                                             const PinholeCamera& camera);

}  // namespace fusebench::places
