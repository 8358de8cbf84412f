#include "eval/mesh_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fusebench {

namespace {

constexpr std::size_t kChunk = 1024;

// Nearer to a point than this, what lies in front of it is taken for the point's own surface.
constexpr double kOwnSurface_m = 0.01;

/// In [0, 1), the same with any library.
double uniform(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1.0p-53; }

std::vector<double> distances(std::span<const Vector3d> points, const SE3& T_tree_points,
                              const TriangleTree& tree, const Workers& workers) {
  std::vector<double> result(points.size());
  workers.for_chunks(points.size(), kChunk, [&](std::size_t begin, std::size_t end) {
    NearestTriangle nearest;
    for (std::size_t i = begin; i < end; ++i) {
      nearest = tree.nearest(T_tree_points * points[i], nearest);
      result[i] = std::sqrt(nearest.squared_m2);
    }
  });
  return result;
}

/// Sorts the values.
MeshDistances summary_of(std::vector<double>& values) {
  MeshDistances summary;
  summary.stats = statistics(values);
  std::ranges::sort(values);
  summary.p90 = percentile(values, 0.90);
  summary.p95 = percentile(values, 0.95);
  return summary;
}

double share_below(std::span<const double> sorted, double limit) {
  const auto end = std::ranges::lower_bound(sorted, limit);
  return static_cast<double>(end - sorted.begin()) / static_cast<double>(sorted.size());
}

/// Views of which one may see a point, tried in turn from the one that saw the last point.
bool is_observed(const Vector3d& point_truth, const TriangleTree& truth, const MeshViews& views,
                 std::span<const SE3> T_camera_truth, std::size_t& first_view) {
  const PinholeCamera& camera = views.camera;
  for (std::size_t tried = 0; tried < T_camera_truth.size(); ++tried) {
    const std::size_t view = (first_view + tried) % T_camera_truth.size();
    const Vector3d point_camera = T_camera_truth[view] * point_truth;
    const double depth_m = point_camera.z();
    if (!(depth_m > 0 && depth_m >= views.min_depth_m && depth_m <= views.max_depth_m)) continue;
    const Vector2d pixel = camera.project(point_camera);
    if (!(pixel.x() >= -0.5 && pixel.x() < camera.width_px - 0.5)) continue;
    if (!(pixel.y() >= -0.5 && pixel.y() < camera.height_px - 0.5)) continue;
    const Vector3d& eye = views.T_truth_camera[view].translation;
    const double distance_m = (point_truth - eye).norm();
    const double clear = std::max(0.0, 1 - kOwnSurface_m / distance_m);
    if (truth.blocked(eye, eye + clear * (point_truth - eye))) continue;
    first_view = view;
    return true;
  }
  return false;
}

}  // namespace

std::string_view to_string(MeshSamples samples) {
  return samples == MeshSamples::vertices ? "vertices" : "area";
}

Result<void> check_mesh(const Mesh& mesh, std::string_view what) {
  if (mesh.triangles.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("{} has no triangles ({} vertices)", what, mesh.vertices.size()),
                "distances are measured to surfaces, not to points");
  }
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& v = mesh.vertices[i];
    if (!v.allFinite()) {
      return fail(ErrorCode::data_corrupt,
                  fmt::format("{}: vertex {} is not finite ({} {} {})", what, i, v.x(), v.y(), v.z()));
    }
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::uint32_t largest = *std::ranges::max_element(mesh.triangles[i]);
    if (largest >= mesh.vertices.size()) {
      return fail(ErrorCode::data_corrupt, fmt::format("{}: triangle {} names vertex {} (there are {})", what,
                                                       i, largest, mesh.vertices.size()));
    }
  }
  return {};
}

Result<std::vector<Vector3d>> sample_mesh(const Mesh& mesh, const MeshSampling& sampling) {
  std::vector<Vector3d> points;
  if (sampling.from == MeshSamples::vertices) {
    for (const Eigen::Vector3f& vertex : mesh.vertices) points.emplace_back(vertex.cast<double>());
    return points;
  }
  std::vector<double> area_until;
  double area = 0;
  const auto corner = [&](std::size_t triangle, std::size_t which) -> Vector3d {
    return mesh.vertices[mesh.triangles[triangle][which]].cast<double>();
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    area += 0.5 * (corner(i, 1) - corner(i, 0)).cross(corner(i, 2) - corner(i, 0)).norm();
    area_until.push_back(area);
  }
  if (!(area > 0)) return fail(ErrorCode::data_corrupt, "the mesh has no area to take samples from");
  std::mt19937_64 random(sampling.seed);
  for (std::size_t i = 0; i < sampling.count; ++i) {
    const double at = area * (static_cast<double>(i) + uniform(random)) / static_cast<double>(sampling.count);
    const auto found = std::ranges::upper_bound(area_until, at);
    const auto triangle =
        std::min(static_cast<std::size_t>(found - area_until.begin()), mesh.triangles.size() - 1);
    const double root = std::sqrt(uniform(random));  // even within the triangle
    const double share = uniform(random);
    points.emplace_back((1 - root) * corner(triangle, 0) + root * (1 - share) * corner(triangle, 1) +
                        root * share * corner(triangle, 2));
  }
  return points;
}

std::vector<Vector3d> observed_points(std::span<const Vector3d> points_truth, const TriangleTree& truth,
                                      const MeshViews& views, const Workers& workers) {
  std::vector<SE3> T_camera_truth;
  for (const SE3& T_truth_camera : views.T_truth_camera) T_camera_truth.push_back(T_truth_camera.inverse());
  const auto parts = workers.map_chunks<std::vector<Vector3d>>(
      points_truth.size(), kChunk, [&](std::size_t begin, std::size_t end) {
        std::vector<Vector3d> seen;
        std::size_t first_view = 0;
        for (std::size_t i = begin; i < end; ++i) {
          if (is_observed(points_truth[i], truth, views, T_camera_truth, first_view))
            seen.push_back(points_truth[i]);
        }
        return seen;
      });
  std::vector<Vector3d> observed;
  for (const auto& part : parts) observed.insert(observed.end(), part.begin(), part.end());
  return observed;
}

double percentile(std::span<const double> sorted, double share) {
  check(!sorted.empty() && share >= 0 && share <= 1, "a percentile of something");
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Result<MeshComparison> MeshComparison::create(const Mesh& reconstruction, const Mesh& truth,
                                              const std::optional<MeshViews>& views,
                                              const MeshErrorOptions& options, const Workers& workers) {
  if (auto usable = check_mesh(reconstruction, "the reconstruction"); !usable) {
    return tl::unexpected(usable.error());
  }
  if (auto usable = check_mesh(truth, "the truth"); !usable) return tl::unexpected(usable.error());
  auto reconstruction_points = sample_mesh(reconstruction, options.reconstruction);
  if (!reconstruction_points) return tl::unexpected(reconstruction_points.error());
  auto truth_points = sample_mesh(truth, options.truth);
  if (!truth_points) return tl::unexpected(truth_points.error());

  MeshComparison comparison(reconstruction, truth);
  comparison.options_ = options;
  comparison.reconstruction_points_ = std::move(*reconstruction_points);
  comparison.truth_samples_ = truth_points->size();
  comparison.truth_points_ =
      views ? observed_points(*truth_points, comparison.truth_, *views, workers) : std::move(*truth_points);
  if (comparison.truth_points_.empty()) {
    return fail(ErrorCode::data_corrupt, "no sample of the true surface is seen from the true poses",
                "are the mesh and the trajectory in one world, and in metres?");
  }
  return comparison;
}

MeshErrorResult MeshComparison::evaluate(const Alignment& alignment, const Workers& workers) const {
  const SE3& T_truth_reconstruction = alignment.T_reference_estimate;
  std::vector<double> to_truth_m = distances(reconstruction_points_, T_truth_reconstruction, truth_, workers);
  std::vector<double> to_reconstruction_m =
      distances(truth_points_, T_truth_reconstruction.inverse(), reconstruction_, workers);
  MeshErrorResult result;
  result.alignment = alignment;
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

}  // namespace fusebench
