// How far a reconstructed surface is from the true one, and how much of the true one it has.
//
// Accuracy: distances from samples of the reconstruction to the true surface. Completeness: distances from
// samples of the ground truth to the reconstruction. Both are exact distances to triangles, in metres.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/mesh_error/mesh_sampling.hpp"
#include "eval/metrics/mesh_error/mesh_views.hpp"
#include "eval/metrics/mesh_error/triangle_tree.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/metrics/trajectory_error/ate_rpe.hpp"

namespace fusebench::mesh_error {

/// Value below which a share of the values lies, interpolated linearly between neighbours. sorted: not empty.
[[nodiscard]] double percentile(std::span<const double> sorted, double share);

/// Of one direction.
struct MeshDistances {
  metrics::Statistics stats;
  double p90 = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
};

/// Shares of samples that are strictly closer than tau.
struct MeshThreshold {
  double tau_m = 0;
  double precision = 0;  ///< of the reconstruction's
  double recall = 0;     ///< of the ground truth's
  double fscore = 0;     ///< harmonic mean; 0 if both are 0
};

struct MeshErrorOptions {
  MeshSampling reconstruction;
  MeshSampling truth;
  std::vector<double> thresholds_m = {0.005, 0.01, 0.02, 0.05};
};

struct MeshErrorResult {
  trajectory_error::Alignment alignment;  ///< of the reconstruction to the ground truth
  MeshDistances accuracy;
  MeshDistances completeness;
  double chamfer_m = std::numeric_limits<double>::quiet_NaN();  ///< mean of both means
  std::vector<MeshThreshold> thresholds;
  /// Share of the reconstruction that stands where nothing is: samples farther than kGhostDistance_m from the
  /// truth that a true camera looks at through free space (a second wall before the wall, not one behind it).
  /// Nothing without views.
  std::optional<double> ghost_share;
};

inline constexpr double kGhostDistance_m = 0.03;

/// Which samples of the ground truth count.
enum class TruthPart { observed, all };

/// Distances from points to a surface, in the order of the points.
[[nodiscard]] std::vector<double> distances_m(std::span<const Vector3d> points, const SE3& T_surface_points,
                                              const TriangleTree& surface, const Workers& workers);

/// Two meshes, ready to be compared under any alignment. Distances to surfels are those to the triangles of
/// with_discs().
class MeshComparison {
 public:
  /// Without views all of the ground truth is taken as observed. Errors data_corrupt: those of check_mesh and
  /// sample_mesh, and a truth of which no sample is observed.
  [[nodiscard]] static Result<MeshComparison> create(const PreciseMesh& reconstruction,
                                                     const PreciseMesh& truth,
                                                     const std::optional<MeshViews>& views,
                                                     const MeshErrorOptions& options, const Workers& workers);

  [[nodiscard]] MeshErrorResult evaluate(const trajectory_error::Alignment& alignment, const Workers& workers,
                                         TruthPart part = TruthPart::observed) const;

  [[nodiscard]] const TriangleTree& truth() const { return truth_; }
  [[nodiscard]] std::span<const Vector3d> reconstruction_points() const { return reconstruction_points_; }
  [[nodiscard]] std::size_t truth_samples() const { return truth_points_.size(); }  ///< before culling
  [[nodiscard]] std::size_t truth_observed() const { return observed_points_.size(); }
  [[nodiscard]] std::size_t reconstruction_samples() const { return reconstruction_points_.size(); }

 private:
  MeshComparison(const PreciseMesh& reconstruction, const PreciseMesh& truth, const Workers& workers);

  [[nodiscard]] double ghost_share(std::span<const double> to_truth_m, const SE3& T_truth_reconstruction,
                                   const Workers& workers) const;

  MeshErrorOptions options_;
  std::optional<MeshViews> views_;  ///< with occlusion
  TriangleTree reconstruction_;
  TriangleTree truth_;
  std::vector<Vector3d> reconstruction_points_;
  std::vector<Vector3d> truth_points_;     ///< all of them
  std::vector<Vector3d> observed_points_;  ///< of the ground truth
};

}  // namespace fusebench::mesh_error
