// Pose graph of places as a least-squares problem for Ceres.
//
// Poses are T_world_camera; the first one is fixed. An edge measures T_a_b; its error and covariance are in
// the tangent of pose_minus(): rotation on the right (rad, frame b), then position (m, frame a). Edges of the
// path have a quadratic loss, edges of loops a robust one (Cauchy, from wide to narrow). Gravity constrains
// roll and pitch: each place has a measured direction in its own frame, and the direction in the world is an
// unknown.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::loops {

struct GraphEdge {
  std::size_t a = 0;
  std::size_t b = 0;
  SE3 T_a_b;
  Matrix6d covariance = Matrix6d::Identity();
  bool robust = false;  ///< true for a loop, which may be false
};

struct PoseGraph {
  std::vector<SE3> T_world_camera;
  std::vector<std::optional<Vector3d>> gravity_camera;  ///< unit, one for each pose; nothing if not given
  double gravity_sigma_rad = 0.01;
  std::vector<GraphEdge> edges;
};

/// Squared Mahalanobis distance of the edge to the poses, by the covariance of the edge alone (six degrees of
/// freedom).
[[nodiscard]] double squared_residual(const GraphEdge& edge, const std::vector<SE3>& T_world_camera);

/// The maximum-likelihood poses. Deterministic: one thread and a fixed order. Errors: run_failed (the search
/// failed, or a covariance is singular).
[[nodiscard]] Result<std::vector<SE3>> optimised_poses(const PoseGraph& graph);

}  // namespace fusebench::loops
