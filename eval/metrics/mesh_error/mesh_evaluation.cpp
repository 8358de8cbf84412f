#include "eval/metrics/mesh_error/mesh_evaluation.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "core/base/geometry.hpp"

namespace fusebench::mesh_error {

namespace {

MeshShape shape_of(const PreciseMesh& mesh) {
  Eigen::AlignedBox3d box;
  const std::vector<Vector3d> vertices = surface_vertices(mesh);
  for (const Vector3d& vertex : vertices) box.extend(vertex);
  return {.vertices = vertices.size(),
          .unused_vertices = mesh.vertices.size() - vertices.size(),
          .triangles = mesh.triangles.size(),
          .surfels = !mesh.radii_m.empty(),
          .extent_m = box.sizes()};
}

/// Millimetres for metres are the usual mistake, and give numbers that look like any others.
Result<void> check_units(const MeshShape& reconstruction, const MeshShape& truth) {
  const double ratio = reconstruction.extent_m.norm() / truth.extent_m.norm();
  if (ratio < kOtherUnit && ratio > 1 / kOtherUnit) return {};
  return fail(ErrorCode::data_corrupt,
              fmt::format("the bounding box of the reconstruction has a diagonal of {:.4g} m, that of the "
                          "ground truth {:.4g} m: one of them is probably not in metres",
                          reconstruction.extent_m.norm(), truth.extent_m.norm()),
              "`--scale 0.001` reads a reconstruction in millimetres, `--scale 1` in metres");
}

/// Evenly spread ones: a registration is not worth more.
std::vector<Vector3d> fewer(std::span<const Vector3d> points) {
  constexpr std::size_t kEnough = 20'000;
  const std::size_t step = (points.size() + kEnough - 1) / kEnough;
  std::vector<Vector3d> taken;
  for (std::size_t i = 0; i < points.size(); i += step) taken.push_back(points[i]);
  return taken;
}

/// Of a wrong place that a registration has stuck in, numbers look like any others.
Result<void> check_registered(const RegistrationResult& icp, const MeshErrorOptions& options, bool started) {
  const double most_m = options.thresholds_m.empty() ? 0 : std::ranges::max(options.thresholds_m);
  if (!(icp.kept_rms_m > most_m)) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("after icp the reconstruction is {:.4g} m (rms) from the ground truth, more than the "
                  "largest threshold, {:g} m: icp probably ended in a wrong minimum",
                  icp.kept_rms_m, most_m),
      fmt::format("icp converges to a minimum near its start{}; for a reconstruction with errors of this "
                  "size, pass a larger last threshold (--thresholds)",
                  started ? ""
                          : ": let it start from the poses, --trajectories TRUTH ESTIMATE (truth.tum and "
                            "trajectory.tum of a run), or from --transform FILE"));
}

/// How far icp moved the points, as a share of their distance from their own centre (both rms).
double moved_share(std::span<const Vector3d> points, const SE3& moved) {
  Vector3d center = Vector3d::Zero();
  for (const Vector3d& point : points) center += point / static_cast<double>(points.size());
  double moved_m2 = 0;
  double radius_m2 = 0;
  for (const Vector3d& point : points) {
    moved_m2 += (moved * point - point).squaredNorm();
    radius_m2 += (point - center).squaredNorm();
  }
  return std::sqrt(moved_m2 / radius_m2);
}

/// Of an icp that had no start.
std::string doubt_of(const RegistrationResult& icp, std::span<const Vector3d> points,
                     const MeshErrorOptions& options) {
  const double most_m = options.thresholds_m.empty() ? 0 : std::ranges::max(options.thresholds_m);
  const double share = moved_share(points, icp.T_surface_points);
  const bool far = share > kNearShare;
  const bool loose = icp.kept_rms_m > kCloseShare * most_m;
  if (!far && !loose) return "";
  const std::string moved =
      fmt::format("moved the reconstruction by {:.0f} % of its radius (turned by {:.1f} deg)", 100 * share,
                  degrees(so3_log(icp.T_surface_points.rotation).norm()));
  const std::string left = fmt::format("left it {:.4g} m (rms) from the ground truth", icp.kept_rms_m);
  return fmt::format(
      "icp had no start, {}: a wrong minimum cannot be distinguished from a bad reconstruction; give a start "
      "with --trajectories TRUTH ESTIMATE (truth.tum and trajectory.tum of a run) or --transform FILE",
      far && loose ? moved + " and " + left
      : far        ? moved
                   : left);
}

Result<void> check_observed(const MeshComparison& comparison, double least) {
  const double share =
      static_cast<double>(comparison.truth_observed()) / static_cast<double>(comparison.truth_samples());
  if (share >= least) return {};
  return fail(
      ErrorCode::data_corrupt,
      fmt::format("only {:.1f} % of the ground-truth surface is observed (required: {:.0f} % or more)",
                  100 * share, 100 * least),
      "are the ground-truth mesh and the recording's poses in one frame? For a recording of a part of the "
      "scene, --min-observed 0.05 (or less) lowers the limit");
}

SurfregScore surfreg_of(const PreciseMesh& reconstruction, const PreciseMesh& truth,
                        const SE3& T_truth_reconstruction, const Workers& workers) {
  std::vector<Vector3d> vertices_truth;
  vertices_truth.reserve(reconstruction.vertices.size());
  for (const Vector3d& vertex : reconstruction.vertices)
    vertices_truth.push_back(T_truth_reconstruction * vertex);
  return surfreg_score(vertices_truth, VertexTree(truth.vertices), workers);
}

}  // namespace

Result<MeshEvaluation> evaluate_mesh(const PreciseMesh& reconstruction, const PreciseMesh& truth,
                                     const MeshRequest& request, const Workers& workers) {
  auto comparison = MeshComparison::create(reconstruction, truth, request.views, request.errors, workers);
  if (!comparison) return tl::unexpected(comparison.error());
  MeshEvaluation result;
  result.reconstruction = shape_of(reconstruction);
  result.truth = shape_of(truth);
  if (!request.any_size) {
    if (auto alike = check_units(result.reconstruction, result.truth); !alike)
      return tl::unexpected(alike.error());
  }
  if (request.views) {
    if (auto enough = check_observed(*comparison, request.least_observed); !enough)
      return tl::unexpected(enough.error());
  }
  trajectory_error::Alignment alignment = request.start;
  if (request.icp) {
    const bool started = request.start.mode != "none";
    const std::vector<Vector3d> points = fewer(comparison->reconstruction_points());
    const auto moved =
        register_points(points, comparison->truth(), alignment.T_reference_estimate, *request.icp, workers);
    if (!moved) return tl::unexpected(moved.error());
    if (auto near = check_registered(*moved, request.errors, started); !near)
      return tl::unexpected(near.error());
    if (!started) result.icp_doubt = doubt_of(*moved, points, request.errors);
    result.icp = *moved;
    alignment = {"icp", moved->T_surface_points};
  }
  result.errors = comparison->evaluate(alignment, workers);
  if (request.views) result.not_culled = comparison->evaluate(alignment, workers, TruthPart::all);
  result.reconstruction_samples = comparison->reconstruction_samples();
  result.truth_samples = comparison->truth_samples();
  result.truth_observed = comparison->truth_observed();
  result.surfreg = surfreg_of(reconstruction, truth, alignment.T_reference_estimate, workers);
  if (request.vertex_errors) {
    result.vertex_errors_m =
        distances_m(reconstruction.vertices, alignment.T_reference_estimate, comparison->truth(), workers);
  }
  return result;
}

}  // namespace fusebench::mesh_error
