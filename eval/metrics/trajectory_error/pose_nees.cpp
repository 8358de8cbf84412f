#include "eval/metrics/trajectory_error/pose_nees.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/geometry.hpp"
#include "eval/metrics/nees_metrics.hpp"
#include "eval/metrics/trajectory_error/trajectory_error.hpp"

namespace fusebench::trajectory_error {

namespace {

constexpr const metrics::StatePart& kOrientationPart = metrics::kStateParts[0];
constexpr const metrics::StatePart& kPositionPart = metrics::kStateParts[1];

/// Of a pose and the ground truth in the estimate's world, positions of both relative to the same point.
std::optional<PoseConsistencyRow> nees_row(const SE3& truth, const SE3& pose, std::int64_t timestamp_ns,
                                           const trajectory_files::PoseCovariance& covariance) {
  PoseConsistencyRow row;
  row.timestamp_ns = timestamp_ns;
  row.orientation_error_rad = so3_log(pose.rotation.conjugate() * truth.rotation);
  row.position_error_m = truth.translation - pose.translation;
  row.orientation_sigma_rad = covariance.orientation_rad2.diagonal().cwiseSqrt();
  row.position_sigma_m = covariance.position_m2.diagonal().cwiseSqrt();

  filter::StateVector error = filter::StateVector::Zero();
  filter::StateMatrix P = filter::StateMatrix::Zero();
  error.segment<3>(filter::kRotation) = row.orientation_error_rad;
  error.segment<3>(filter::kPosition) = row.position_error_m;
  P.block<3, 3>(filter::kRotation, filter::kRotation) = covariance.orientation_rad2;
  P.block<3, 3>(filter::kPosition, filter::kPosition) = covariance.position_m2;
  const auto orientation = metrics::normalised_error_squared(error, P, kOrientationPart);
  const auto position = metrics::normalised_error_squared(error, P, kPositionPart);
  if (!orientation || !position) return std::nullopt;
  row.orientation_nees = *orientation / kOrientationPart.dof;
  row.position_nees = *position / kPositionPart.dof;
  return row;
}

PartConsistency part_of(const std::vector<PoseConsistencyRow>& rows, double PoseConsistencyRow::*nees,
                        Vector3d PoseConsistencyRow::*error, Vector3d PoseConsistencyRow::*sigma) {
  PartConsistency part;
  std::vector<double> all;
  Vector3d within = Vector3d::Zero();
  double error_squared = 0;
  double sigma_squared = 0;
  for (const PoseConsistencyRow& row : rows) {
    all.push_back(row.*nees);
    error_squared += (row.*error).squaredNorm();
    sigma_squared += (row.*sigma).squaredNorm();
    for (int axis = 0; axis < 3; ++axis)
      within[axis] += std::abs((row.*error)[axis]) <= 3 * (row.*sigma)[axis] ? 1 : 0;
  }
  const auto count = static_cast<double>(rows.size());
  part.nees = metrics::statistics(all);
  part.error_rmse = std::sqrt(error_squared / count);
  part.sigma_rms = std::sqrt(sigma_squared / count);
  part.share_within_3_sigma = within / count;
  return part;
}

}  // namespace

Result<PoseConsistency> pose_consistency(const Trajectory& reference,
                                         const trajectory_files::LoadedTrajectory& estimate,
                                         const trajectory_files::AssociationOptions& association,
                                         const AlignmentRequest& alignment) {
  if (estimate.covariances.empty()) {
    return fail(
        ErrorCode::usage,
        fmt::format("the estimate ({}) has no covariances", trajectory_files::to_string(estimate.format)),
        "a row of ov_eval's format has them: timestamp, position, quaternion, and the upper triangles "
        "of the covariances of orientation and position (20 columns)");
  }
  if (alignment.mode == AlignmentMode::sim3 || alignment.mode == AlignmentMode::scale) {
    return fail(ErrorCode::usage, "covariances in metres say nothing of an estimate without scale",
                "align by none, se3, yaw or origin");
  }
  const auto pair = trajectory_files::pair_up(reference, estimate.poses, association);
  if (!pair) return tl::unexpected(pair.error());
  const auto aligned = align(*pair, alignment);
  if (!aligned) return tl::unexpected(aligned.error());

  PoseConsistency result;
  result.pairs = pair->size();
  result.possible = pair->possible;
  result.T_reference_estimate = *aligned;
  const Quaterniond R_estimate_reference = aligned->rigid.rotation.conjugate();
  for (std::size_t i = 0; i < pair->size(); ++i) {
    const StampedPose& pose = pair->estimate[i];
    const auto owner =
        std::ranges::lower_bound(estimate.poses, pose.timestamp_ns, {}, &StampedPose::timestamp_ns);
    // Both in the estimate's world, positions relative to the centre of the alignment.
    const SE3& truth = pair->reference[i].T_world_camera;
    const SE3 truth_there{
        (R_estimate_reference * truth.rotation).normalized(),
        R_estimate_reference * Vector3d(truth.translation - aligned->image - aligned->shift)};
    const SE3 pose_there{pose.T_world_camera.rotation, pose.T_world_camera.translation - aligned->centre};
    const auto row = nees_row(truth_there, pose_there, pose.timestamp_ns,
                              estimate.covariances[static_cast<std::size_t>(owner - estimate.poses.begin())]);
    if (row) {
      result.rows.push_back(*row);
    } else {
      ++result.singular;
    }
  }
  if (result.rows.empty()) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the covariances of all {} compared poses are singular", result.pairs),
                "an estimator that is sure of a direction beyond doubt has no NEES");
  }
  result.orientation =
      part_of(result.rows, &PoseConsistencyRow::orientation_nees, &PoseConsistencyRow::orientation_error_rad,
              &PoseConsistencyRow::orientation_sigma_rad);
  result.position = part_of(result.rows, &PoseConsistencyRow::position_nees,
                            &PoseConsistencyRow::position_error_m, &PoseConsistencyRow::position_sigma_m);
  return result;
}

}  // namespace fusebench::trajectory_error
