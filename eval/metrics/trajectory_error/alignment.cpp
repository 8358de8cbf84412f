#include "eval/metrics/trajectory_error/alignment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/solvers.hpp"
#include "eval/metrics/trajectory_files/coordinate_rounding.hpp"

namespace fusebench::trajectory_error {

namespace {

// Of the largest singular value: an absolute limit alone lets long oblique lines pass through rounding.
constexpr double kRankTolerance = 1e-9;
// Of a quaternion (w, z) that turns about z: less is rounding of orientations with four decimals.
constexpr double kLeastYawNorm = 1e-3;
// A motion is observable if it is more than so many times what rounding can give.
constexpr double kRoundings = 2;

std::vector<Vector3d> positions_of(std::span<const SE3> poses) {
  std::vector<Vector3d> positions;
  positions.reserve(poses.size());
  for (const SE3& pose : poses) positions.push_back(pose.translation);
  return positions;
}

/// Positions of one side: first + mean + offset.
struct Side {
  std::string_view name;
  Vector3d first;
  Vector3d mean;  ///< of the differences from the first
  std::vector<Vector3d> offsets;
  double rounding = 0;  ///< see coordinate_rounding()

  Side(std::string_view whose, std::span<const Vector3d> positions)
      : name(whose), first(positions[0]), rounding(trajectory_files::coordinate_rounding(positions)) {
    // Sums of differences, so that equal positions have offsets of exactly zero.
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& position : positions) sum += position - first;
    mean = sum / static_cast<double>(positions.size());
    offsets.reserve(positions.size());
    for (const Vector3d& position : positions) offsets.push_back((position - first) - mean);
  }

  [[nodiscard]] double count() const { return static_cast<double>(offsets.size()); }
  [[nodiscard]] double sum_of_squares() const {
    double sum = 0;
    for (const Vector3d& offset : offsets) sum += offset.squaredNorm();
    return sum;
  }
  /// Root mean square of the offsets along directions (columns, orthonormal).
  template <typename Directions>
  [[nodiscard]] double spread(const Directions& directions) const {
    double sum = 0;
    for (const Vector3d& offset : offsets) sum += (directions.transpose() * offset).squaredNorm();
    return std::sqrt(sum / count());
  }
  /// Whether the offsets along directions can be rounding alone.
  template <typename Directions>
  [[nodiscard]] bool is_still(const Directions& directions) const {
    return spread(directions) <= 2 * kRoundings * std::numbers::sqrt3 * rounding;
  }
};

/// The similarity of a scale and a rotation that brings the mean of the estimate to that of the reference.
Similarity between_means(const Side& reference, const Side& estimate, double scale,
                         const Quaterniond& rotation) {
  return Similarity::mapping(scale, rotation, estimate.first, reference.first,
                             reference.mean - rotation * Vector3d(scale * estimate.mean));
}

/// sum_i g_i p_i^T of offsets from the centres.
Matrix3d cross_covariance(const Side& reference, const Side& estimate) {
  Matrix3d sum = Matrix3d::Zero();
  for (std::size_t i = 0; i < reference.offsets.size(); ++i)
    sum += reference.offsets[i] * estimate.offsets[i].transpose();
  return sum;
}

/// What rounding can give sum_i a_i b_i of coordinates with these spreads.
double rounding_of_products(const Side& reference, double reference_spread, const Side& estimate,
                            double estimate_spread) {
  return reference.count() * (reference.rounding * estimate_spread + estimate.rounding * reference_spread +
                              reference.rounding * estimate.rounding);
}

tl::unexpected<Error> undetermined(const std::string& why, std::string_view remedy = "") {
  return fail(
      ErrorCode::data_corrupt, fmt::format("the trajectory cannot be aligned: {}", why),
      fmt::format(
          "{}--align origin or --align none of `fusebench eval`, in place of -a, -s, --align_origin or "
          "another --align, needs no motion; rotation and scale from positions need three that are not on "
          "one line",
          remedy));
}

/// Length of the diagonal of the box around the positions.
template <typename Directions>
double extent_m(const Side& side, const Directions& directions) {
  auto least = (directions.transpose() * side.offsets[0]).eval();
  auto most = least;
  for (const Vector3d& offset : side.offsets) {
    const auto along = (directions.transpose() * offset).eval();
    least = least.cwiseMin(along);
    most = most.cwiseMax(along);
  }
  return (most - least).norm();
}

/// Of positions that do not determine a rotation. across: the two axes across the main motion of each side.
tl::unexpected<Error> undetermined_rotation(const Side& reference, const Matrix3x2d& across_reference,
                                            const Side& estimate, const Matrix3x2d& across_estimate) {
  const Matrix3d all = Matrix3d::Identity();
  for (const Side* side : {&reference, &estimate}) {
    if (side->is_still(all)) {
      return undetermined(fmt::format("the {} does not move: its {} matched positions extend over {:.3g} m",
                                      side->name, side->offsets.size(), extent_m(*side, all)));
    }
  }
  for (const auto& [side, across] :
       {std::pair(&reference, &across_reference), std::pair(&estimate, &across_estimate)}) {
    const bool is_line =
        side->is_still(*across) || side->spread(*across) <= std::sqrt(kRankTolerance) * side->spread(all);
    if (is_line) {
      return undetermined(
          fmt::format("the {} moves along a straight line ({} matched positions extend over {:.3g} m, and "
                      "{:.3g} m across "
                      "the line), so that the rotation about it is arbitrary",
                      side->name, side->offsets.size(), extent_m(*side, all), extent_m(*side, *across)));
    }
  }
  return undetermined(fmt::format(
      "the motions of the reference and the estimate ({} matched positions) have no unique best rotation",
      reference.offsets.size()));
}

/// Rotation about z that turns the estimate's positions closest to the reference's.
Result<Similarity> align_yaw(std::span<const SE3> reference_poses, std::span<const SE3> estimate_poses) {
  const Side reference("reference", positions_of(reference_poses));
  const Side estimate("estimate", positions_of(estimate_poses));
  const bool by_orientation = reference_poses.size() == 1;
  const Matrix3d H =
      by_orientation
          ? Matrix3d(reference_poses[0].rotation_matrix() * estimate_poses[0].rotation_matrix().transpose())
          : cross_covariance(reference, estimate);
  const double cosine = H(0, 0) + H(1, 1);
  const double sine = H(1, 0) - H(0, 1);
  const Matrix3x2d horizontal = Matrix3d::Identity().leftCols<2>();
  // Two products for each pose, with errors of two coordinates.
  // Of a quaternion (w, x, y, z), hypot(cosine, sine) = 2 (w^2 + z^2).
  const double from_rounding = by_orientation
                                   ? 2 * kLeastYawNorm * kLeastYawNorm
                                   : kRoundings * std::numbers::sqrt2 *
                                         rounding_of_products(reference, reference.spread(horizontal),
                                                              estimate, estimate.spread(horizontal));
  const double least = std::max(
      from_rounding, kRankTolerance * std::sqrt(reference.sum_of_squares() * estimate.sum_of_squares()));
  // Written so that NaN and all-zero fail.
  if (!(std::hypot(cosine, sine) > least)) {
    for (const Side* side : {&reference, &estimate}) {
      if (by_orientation || !side->is_still(horizontal)) continue;
      return undetermined(fmt::format(
          "the {} does not move horizontally ({} matched positions extend over {:.3g} m), so that "
          "the rotation about z is arbitrary",
          side->name, side->offsets.size(), extent_m(*side, horizontal)));
    }
    return undetermined(
        by_orientation
            ? "the z axes of the only pair of poses are opposite, so that the rotation about z is arbitrary"
            : "the reference and the estimate have no unique best rotation about z");
  }
  return between_means(reference, estimate, 1, so3_exp(std::atan2(sine, cosine) * Vector3d::UnitZ()));
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

Result<Similarity> align_positions(std::span<const Vector3d> reference_m,
                                   std::span<const Vector3d> estimate_m, bool with_scale) {
  check(reference_m.size() == estimate_m.size(), "points to align come in pairs");
  if (reference_m.size() < 3)
    return undetermined(fmt::format("{} matched positions", reference_m.size()), "take more frames: ");
  const Side reference("reference", reference_m);
  const Side estimate("estimate", estimate_m);
  const Eigen::JacobiSVD<Matrix3d> svd(cross_covariance(reference, estimate),
                                       Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d singular = svd.singularValues();
  Vector3d signs = Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;  // no reflections
  double from_rounding = 0;
  for (const int axis : {1, 2}) {
    from_rounding += rounding_of_products(reference, reference.spread(svd.matrixU().col(axis)), estimate,
                                          estimate.spread(svd.matrixV().col(axis)));
  }
  const double curvature = singular[1] + signs.z() * singular[2];
  // Written so that NaN and all-zero fail.
  if (!(curvature > std::max(kRankTolerance * singular[0], kRoundings * from_rounding))) {
    return undetermined_rotation(reference, svd.matrixU().rightCols<2>(), estimate,
                                 svd.matrixV().rightCols<2>());
  }
  const Quaterniond rotation(Matrix3d(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose()));
  const double scale = with_scale ? singular.dot(signs) / estimate.sum_of_squares() : 1.0;
  return between_means(reference, estimate, scale, rotation.normalized());
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
    return Similarity::mapping(scale, (reference[0].rotation * estimate[0].rotation.conjugate()).normalized(),
                               estimate[0].translation, reference[0].translation, Vector3d::Zero());
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
