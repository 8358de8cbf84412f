#include "eval/trajectory_error/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/solvers.hpp"

namespace fusebench::trajectory_error {

namespace {

// Relative, because an absolute limit lets long oblique lines pass through rounding.
constexpr double kRankTolerance = 1e-9;

Vector3d centroid(std::span<const Vector3d> points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

std::vector<Vector3d> positions_of(std::span<const SE3> poses) {
  std::vector<Vector3d> positions;
  positions.reserve(poses.size());
  for (const SE3& pose : poses) positions.push_back(pose.translation);
  return positions;
}

tl::unexpected<Error> undetermined(const std::string& why, std::string_view remedy = "take more frames") {
  return fail(ErrorCode::data_corrupt, fmt::format("the trajectory cannot be aligned: {}", why),
              fmt::format("{}: alignment of positions needs three that are not on one line; `fusebench eval "
                          "ape` with --align origin or none needs one",
                          remedy));
}

bool hardly_move(std::span<const Vector3d> positions) {
  constexpr double kStill_m = 0.001;
  return std::ranges::all_of(
      positions, [&](const Vector3d& position) { return (position - positions[0]).norm() < kStill_m; });
}

/// Of positions of which one set lies on a line or in a point, so that they do not tell a rotation.
tl::unexpected<Error> flat_positions(std::span<const Vector3d> reference,
                                     std::span<const Vector3d> estimate) {
  const auto still = [&](std::string_view whose) {
    return fmt::format("the camera hardly moves in {} between its {} matched positions", whose,
                       reference.size());
  };
  if (hardly_move(reference)) return undetermined(still("the ground truth"));
  if (hardly_move(estimate)) return undetermined(still("the estimate"), "look why it stands still");
  return undetermined(fmt::format("its {} matched positions lie on a line", reference.size()));
}

/// Rotation about z that turns the estimate's positions closest to the reference's.
Similarity align_yaw(std::span<const SE3> reference, std::span<const SE3> estimate) {
  const std::vector<Vector3d> p_reference = positions_of(reference);
  const std::vector<Vector3d> p_estimate = positions_of(estimate);
  const Vector3d reference_centre = centroid(p_reference);
  const Vector3d estimate_centre = centroid(p_estimate);
  Matrix3d correlation = Matrix3d::Zero();
  if (reference.size() == 1) {
    correlation = estimate[0].rotation_matrix() * reference[0].rotation_matrix().transpose();
  } else {
    for (std::size_t i = 0; i < p_reference.size(); ++i)
      correlation += (p_estimate[i] - estimate_centre) * (p_reference[i] - reference_centre).transpose();
  }
  const double yaw_rad = 0.5 * std::numbers::pi - std::atan2(correlation(0, 0) + correlation(1, 1),
                                                             correlation(0, 1) - correlation(1, 0));
  Similarity result;
  result.rigid.rotation = so3_exp(yaw_rad * Vector3d::UnitZ());
  result.rigid.translation = reference_centre - result.rigid.rotation * estimate_centre;
  return result;
}

}  // namespace

std::string_view to_string(AlignmentMode mode) {
  switch (mode) {
    case AlignmentMode::none:
      return "none";
    case AlignmentMode::se3:
      return "se3";
    case AlignmentMode::sim3:
      return "sim3";
    case AlignmentMode::scale:
      return "scale";
    case AlignmentMode::yaw:
      return "yaw";
    case AlignmentMode::origin:
      return "origin";
  }
  return "";
}

Result<Similarity> align_positions(std::span<const Vector3d> reference, std::span<const Vector3d> estimate,
                                   bool with_scale) {
  check(reference.size() == estimate.size(), "points to align come in pairs");
  if (reference.size() < 3) return undetermined(fmt::format("{} matched positions", reference.size()));
  const Vector3d reference_centre = centroid(reference);
  const Vector3d estimate_centre = centroid(estimate);
  Matrix3d covariance = Matrix3d::Zero();
  double estimate_variance = 0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const Vector3d from_centre = estimate[i] - estimate_centre;
    covariance += (reference[i] - reference_centre) * from_centre.transpose();
    estimate_variance += from_centre.squaredNorm();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d singular = svd.singularValues();
  // Written so that NaN and all-zero fail.
  if (!(singular[1] > kRankTolerance * singular[0])) return flat_positions(reference, estimate);
  Vector3d signs = Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;  // no reflections
  Similarity result;
  result.rigid.rotation =
      Quaterniond(Matrix3d(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose())).normalized();
  if (with_scale) result.scale = singular.dot(signs) / estimate_variance;
  result.rigid.translation =
      reference_centre - result.rigid.rotation * Vector3d(result.scale * estimate_centre);
  return result;
}

Result<Similarity> align(std::span<const SE3> reference, std::span<const SE3> estimate,
                         const AlignmentRequest& request) {
  check(reference.size() == estimate.size(), "poses to align come in pairs");
  if (reference.empty()) return undetermined("no matched poses");
  if (request.mode == AlignmentMode::none) return Similarity{};
  const std::size_t used = request.first == 0 ? reference.size() : std::min(request.first, reference.size());
  const auto reference_used = reference.first(used);
  const auto estimate_used = estimate.first(used);

  const auto onto_first = [&](double scale) {
    const SE3 scaled{estimate[0].rotation, scale * estimate[0].translation};
    return Similarity{scale, reference[0] * scaled.inverse()};
  };
  if (request.mode == AlignmentMode::yaw) return align_yaw(reference_used, estimate_used);
  if (request.mode == AlignmentMode::origin && !request.scale_origin) return onto_first(1);
  if (request.mode == AlignmentMode::se3 && request.single_pose && used == 1) return onto_first(1);

  const bool with_scale = request.mode != AlignmentMode::se3;
  const Result<Similarity> best =
      align_positions(positions_of(reference_used), positions_of(estimate_used), with_scale);
  if (!best) return best;
  if (request.mode == AlignmentMode::scale) return Similarity{best->scale, {}};
  if (request.mode == AlignmentMode::origin) return onto_first(best->scale);
  return best;
}

}  // namespace fusebench::trajectory_error
