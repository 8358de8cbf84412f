// Two meshes from anywhere, compared as it is requested.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "eval/metrics/mesh_error/mesh_sampling.hpp"
#include "eval/metrics/mesh_error/surface_registration.hpp"
#include "eval/metrics/mesh_error/vertex_tree.hpp"

namespace fusebench::mesh_error {

struct MeshRequest {
  MeshErrorOptions errors = {};
  trajectory_error::Alignment start =
      {};  ///< of the reconstruction to the ground truth, before any registration
  std::optional<RegistrationOptions> icp = {};
  std::optional<MeshViews> views = {};  ///< from where the ground truth was seen; absent: all of it counts
  double least_observed = 0.2;          ///< share of the ground truth's samples
  bool any_size = false;                ///< meshes whose sizes differ as units do are compared all the same
  bool vertex_errors = false;           ///< asks for the distance of each vertex of the reconstruction
};

/// What a mesh is, in words of size.
struct MeshShape {
  std::size_t vertices = 0;         ///< of the surface, see surface_vertices()
  std::size_t unused_vertices = 0;  ///< that no triangle names; they do not count in the extent
  std::size_t triangles = 0;
  bool surfels = false;                  ///< each vertex is a disc
  Vector3d extent_m = Vector3d::Zero();  ///< of the box around its surface vertices
};

struct MeshEvaluation {
  MeshShape reconstruction;
  MeshShape truth;
  std::size_t reconstruction_samples = 0;
  std::size_t truth_samples = 0;
  std::size_t truth_observed = 0;
  MeshErrorResult errors;                     ///< completeness of what is observed
  std::optional<MeshErrorResult> not_culled;  ///< with views: of all of the ground truth
  std::optional<RegistrationResult> icp;
  std::string icp_doubt;  ///< why icp may have found another place, and what settles it; empty: no reason
  SurfregScore surfreg;
  std::vector<double> vertex_errors_m;  ///< if they were requested
};

/// Largest of a mesh's extents over the other's, from which on one is not taken for metres.
inline constexpr double kOtherUnit = 20;

/// Where nothing says where the reconstruction is (start.mode is "none"), icp takes the nearest points for
/// the same ones. That holds near the right place only, and a wrong one is not told from a bad reconstruction
/// by its distances. So there is a doubt (icp_doubt) if the reconstruction moved by more than kNearShare of
/// its own radius (rms; a turn of 14 degrees), or if the points that count are still further from the ground
/// truth (rms) than kCloseShare of the largest threshold.
inline constexpr double kNearShare = 0.25;
inline constexpr double kCloseShare = 0.4;

/// Errors data_corrupt: those of MeshComparison::create and register_points; boxes that differ kOtherUnit
/// times in size; a truth of which less than least_observed is seen; or a registration that leaves the points
/// that count further from the ground truth (rms) than the largest threshold.
[[nodiscard]] Result<MeshEvaluation> evaluate_mesh(const PreciseMesh& reconstruction,
                                                   const PreciseMesh& truth, const MeshRequest& request,
                                                   const Workers& workers);

}  // namespace fusebench::mesh_error
