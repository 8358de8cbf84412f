// How far a reconstructed surface is from the true one, and how much of the true one it has.
//
// Accuracy: distances from samples of the reconstruction to the true surface. Completeness: distances from
// samples of the truth to the reconstruction. Both are exact distances to triangles, in metres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/parallel.hpp"
#include "core/types.hpp"
#include "eval/statistics.hpp"
#include "eval/trajectory_metrics.hpp"
#include "eval/triangle_tree.hpp"

namespace fusebench {

/// Which points of a surface are measured.
enum class MeshSamples {
  vertices,  ///< all of them, so a finely meshed part counts more
  area,      ///< spread evenly over the area by a seed
};
[[nodiscard]] std::string_view to_string(MeshSamples samples);  ///< "vertices", "area"

struct MeshSampling {
  MeshSamples from = MeshSamples::area;
  std::size_t count = 50'000;  ///< of area
  std::uint64_t seed = 1;      ///< of area
};

/// Error data_corrupt if the mesh has no triangles, a vertex that is not finite, or a triangle with a vertex
/// that does not exist. `what` names the mesh.
[[nodiscard]] Result<void> check_mesh(const Mesh& mesh, std::string_view what);

/// Samples of a mesh that check_mesh accepts. Of area: one in each of `count` parts of equal area, by the
/// order of the triangles. Error data_corrupt: a mesh without area.
[[nodiscard]] Result<std::vector<Vector3d>> sample_mesh(const Mesh& mesh, const MeshSampling& sampling);

/// From where the truth was seen. A point is observed if some view has it inside its image and its range of
/// depth, and nothing of the truth lies between it and the camera (but for the last centimetre).
struct MeshViews {
  PinholeCamera camera;
  double min_depth_m = 0;
  double max_depth_m = std::numeric_limits<double>::infinity();
  std::vector<SE3> T_truth_camera;
};
[[nodiscard]] std::vector<Vector3d> observed_points(std::span<const Vector3d> points_truth,
                                                    const TriangleTree& truth, const MeshViews& views,
                                                    const Workers& workers);

/// Value below which a share of the values lies, interpolated linearly between neighbours. sorted: not empty.
[[nodiscard]] double percentile(std::span<const double> sorted, double share);

/// Of one direction.
struct MeshDistances {
  Statistics stats;
  double p90 = std::numeric_limits<double>::quiet_NaN();
  double p95 = std::numeric_limits<double>::quiet_NaN();
};

/// Shares of samples that are strictly closer than tau.
struct MeshThreshold {
  double tau_m = 0;
  double precision = 0;  ///< of the reconstruction's
  double recall = 0;     ///< of the truth's
  double fscore = 0;     ///< harmonic mean; 0 if both are 0
};

struct MeshErrorOptions {
  MeshSampling reconstruction;
  MeshSampling truth;
  std::vector<double> thresholds_m = {0.005, 0.01, 0.02, 0.05};
};

struct MeshErrorResult {
  Alignment alignment;  ///< of the reconstruction to the truth
  MeshDistances accuracy;
  MeshDistances completeness;
  double chamfer_m = std::numeric_limits<double>::quiet_NaN();  ///< mean of both means
  std::vector<MeshThreshold> thresholds;
};

/// Two meshes, ready to be compared under any alignment.
class MeshComparison {
 public:
  /// Without views all of the truth counts. Errors data_corrupt: those of check_mesh and sample_mesh, and a
  /// truth of which no sample is observed.
  [[nodiscard]] static Result<MeshComparison> create(const Mesh& reconstruction, const Mesh& truth,
                                                     const std::optional<MeshViews>& views,
                                                     const MeshErrorOptions& options, const Workers& workers);

  [[nodiscard]] MeshErrorResult evaluate(const Alignment& alignment, const Workers& workers) const;

  [[nodiscard]] std::size_t truth_samples() const { return truth_samples_; }  ///< before culling
  [[nodiscard]] std::size_t truth_observed() const { return truth_points_.size(); }
  [[nodiscard]] std::size_t reconstruction_samples() const { return reconstruction_points_.size(); }

 private:
  MeshComparison(const Mesh& reconstruction, const Mesh& truth)
      : reconstruction_(reconstruction), truth_(truth) {}

  MeshErrorOptions options_;
  TriangleTree reconstruction_;
  TriangleTree truth_;
  std::vector<Vector3d> reconstruction_points_;
  std::vector<Vector3d> truth_points_;  ///< the observed ones
  std::size_t truth_samples_ = 0;
};

}  // namespace fusebench
