#include "eval/metrics/mesh_error/mesh_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "eval/metrics/mesh_error/surfel_discs.hpp"

namespace fusebench::mesh_error {

namespace {

constexpr std::size_t kSamplesPerChunk = 1024;

/// Sorts the values.
MeshDistances summary_of(std::vector<double>& values) {
  MeshDistances summary;
  summary.stats = metrics::statistics(values);
  std::ranges::sort(values);
  summary.p90 = percentile(values, 0.90);
  summary.p95 = percentile(values, 0.95);
  return summary;
}

double share_below(std::span<const double> sorted, double limit) {
  const auto end = std::ranges::lower_bound(sorted, limit);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

TriangleTree tree_of(const PreciseMesh& mesh, const Workers& workers) {
  return mesh.radii_m.empty() ? TriangleTree(mesh, workers) : TriangleTree(with_discs(mesh), workers);
}

}  // namespace

std::vector<double> distances_m(std::span<const Vector3d> points, const SE3& T_surface_points,
                                const TriangleTree& surface, const Workers& workers) {
  std::vector<double> result(points.size());
  workers.for_chunks(points.size(), kSamplesPerChunk, [&](std::size_t begin, std::size_t end) {
    NearestTriangle nearest;
    for (std::size_t i = begin; i < end; ++i) {
      nearest = surface.nearest(T_surface_points * points[i], nearest);
      result[i] = std::sqrt(nearest.squared_m2);
    }
  });
  return result;
}

double percentile(std::span<const double> sorted, double share) {
  check(!sorted.empty() && share >= 0 && share <= 1, "a percentile of something");
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

MeshComparison::MeshComparison(const PreciseMesh& reconstruction, const PreciseMesh& truth,
                               const Workers& workers)
    : reconstruction_(tree_of(reconstruction, workers)), truth_(tree_of(truth, workers)) {}

Result<MeshComparison> MeshComparison::create(const PreciseMesh& reconstruction, const PreciseMesh& truth,
                                              const std::optional<MeshViews>& views,
                                              const MeshErrorOptions& options, const Workers& workers) {
  if (auto usable = check_mesh(reconstruction, "the reconstruction"); !usable) {
    return tl::unexpected(usable.error());
  }
  if (auto usable = check_mesh(truth, "the ground truth"); !usable) return tl::unexpected(usable.error());
  auto reconstruction_points = sample_mesh(reconstruction, options.reconstruction);
  if (!reconstruction_points) return tl::unexpected(reconstruction_points.error());
  auto truth_points = sample_mesh(truth, options.truth);
  if (!truth_points) return tl::unexpected(truth_points.error());

  MeshComparison comparison(reconstruction, truth, workers);
  comparison.options_ = options;
  comparison.reconstruction_points_ = std::move(*reconstruction_points);
  comparison.truth_points_ = std::move(*truth_points);
  if (views) {
    comparison.views_ = MeshViews{views->camera,         views->min_depth_m, views->max_depth_m,
                                  views->T_truth_camera, Culling::occlusion, {}};
    for (const std::size_t i : observed_points(comparison.truth_points_, comparison.truth_, *views, workers))
      comparison.observed_points_.push_back(comparison.truth_points_[i]);
  } else {
    comparison.observed_points_ = comparison.truth_points_;
  }
  if (comparison.observed_points_.empty()) {
    return fail(ErrorCode::data_corrupt,
                "no sample of the ground-truth surface is visible from the ground-truth poses",
                "are the mesh and the trajectory in one frame and in metres?");
  }
  return comparison;
}

double MeshComparison::ghost_share(std::span<const double> to_truth_m, const SE3& T_truth_reconstruction,
                                   const Workers& workers) const {
  std::vector<Vector3d> far;
  for (std::size_t i = 0; i < to_truth_m.size(); ++i) {
    if (to_truth_m[i] > kGhostDistance_m) far.push_back(T_truth_reconstruction * reconstruction_points_[i]);
  }
  const std::size_t ghosts = observed_points(far, truth_, *views_, workers).size();
  return static_cast<double>(ghosts) / static_cast<double>(to_truth_m.size());
}

MeshErrorResult MeshComparison::evaluate(const trajectory_error::Alignment& alignment, const Workers& workers,
                                         TruthPart part) const {
  const SE3& T_truth_reconstruction = alignment.T_reference_estimate;
  std::vector<double> to_truth_m =
      distances_m(reconstruction_points_, T_truth_reconstruction, truth_, workers);
  std::vector<double> to_reconstruction_m =
      distances_m(part == TruthPart::all ? truth_points_ : observed_points_, T_truth_reconstruction.inverse(),
                  reconstruction_, workers);
  MeshErrorResult result;
  result.alignment = alignment;
  if (views_) result.ghost_share = ghost_share(to_truth_m, T_truth_reconstruction, workers);
  result.accuracy = summary_of(to_truth_m);
  result.completeness = summary_of(to_reconstruction_m);
  result.chamfer_m = 0.5 * (result.accuracy.stats.mean + result.completeness.stats.mean);
  for (const double tau_m : options_.thresholds_m) {
    const double precision = share_below(to_truth_m, tau_m);
    const double recall = share_below(to_reconstruction_m, tau_m);
    const double sum = precision + recall;
    result.thresholds.push_back({tau_m, precision, recall, sum > 0 ? 2 * precision * recall / sum : 0});
  }
  return result;
}

}  // namespace fusebench::mesh_error
