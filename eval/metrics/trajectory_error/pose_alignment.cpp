#include "eval/metrics/trajectory_error/pose_alignment.hpp"

#include "core/base/solvers.hpp"

namespace fusebench::trajectory_error {

namespace {

// Of the mean rotation matrix; all orientations equal would give ones.
constexpr double kLeastAgreement = 1e-6;

}  // namespace

Result<SE3> align_poses(std::span<const SE3> reference, std::span<const SE3> estimate) {
  check(reference.size() == estimate.size(), "poses to align come in pairs");
  if (reference.empty()) return fail(ErrorCode::data_corrupt, "there are no poses to align");
  Matrix3d sum = Matrix3d::Zero();
  // Sums of differences from the first positions keep the digits of positions far from the origin.
  const Vector3d& reference_start = reference[0].translation;
  const Vector3d& estimate_start = estimate[0].translation;
  Vector3d reference_sum = Vector3d::Zero();
  Vector3d estimate_sum = Vector3d::Zero();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    sum += reference[i].rotation_matrix() * estimate[i].rotation_matrix().transpose();
    reference_sum += reference[i].translation - reference_start;
    estimate_sum += estimate[i].translation - estimate_start;
  }
  const auto count = static_cast<double>(reference.size());
  const Eigen::JacobiSVD<Matrix3d> svd(sum / count, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs = Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  if (!(svd.singularValues()[1] + signs.z() * svd.singularValues()[2] > kLeastAgreement)) {
    return fail(ErrorCode::data_corrupt, "the orientations of the trajectories have nothing in common");
  }
  SE3 T_reference_estimate;
  T_reference_estimate.rotation =
      Quaterniond(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose()).normalized();
  T_reference_estimate.translation =
      (reference_start + reference_sum / count) -
      T_reference_estimate.rotation * Vector3d(estimate_start + estimate_sum / count);
  return T_reference_estimate;
}

}  // namespace fusebench::trajectory_error
