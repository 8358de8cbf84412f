// Poses of places, and what is known between them: a least-squares problem for Ceres.
//
// Poses map a camera to the world; the first one is fixed. An edge says T_a_b; its error and covariance are
// in the tangent of pose_minus(): rotation on the right (rad, frame b), then position (m, frame a). Edges of
// the path are trusted; those of loops are robust (Cauchy, from wide to narrow). Gravity pins roll and pitch:
// each place says its direction in its own frame, and that in the world is an unknown as well.
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
  bool robust = false;  ///< of a loop, which may be false
};

struct PoseGraph {
  std::vector<SE3> T_world_camera;
  std::vector<std::optional<Vector3d>> gravity_camera;  ///< unit, one a pose; nothing where it is not known
  double gravity_sigma_rad = 0.01;
  std::vector<GraphEdge> edges;
};

/// The squared distance of the edge to the poses, by its own covariance alone: of six degrees of freedom.
[[nodiscard]] double squared_residual(const GraphEdge& edge, const std::vector<SE3>& T_world_camera);

/// The most probable poses. One thread, a fixed order: the same graph gives the same bytes. Errors:
/// run_failed (the search failed, or a covariance is singular).
[[nodiscard]] Result<std::vector<SE3>> optimised_poses(const PoseGraph& graph);

}  // namespace fusebench::loops
