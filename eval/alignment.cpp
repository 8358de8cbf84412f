#include "eval/alignment.hpp"

#include <fmt/format.h>
#include <Eigen/SVD>

namespace fusebench {

namespace {

// Relative, because an absolute limit lets long oblique lines pass through rounding.
constexpr double kRankTolerance = 1e-9;

Vector3d centroid(std::span<const Vector3d> points) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& point : points) sum += point;
  return sum / static_cast<double>(points.size());
}

}  // namespace

Result<SE3> align_se3(std::span<const Vector3d> reference, std::span<const Vector3d> estimate) {
  check(reference.size() == estimate.size(), "points to align come in pairs");
  const char* const hint = "SE3 alignment needs three positions that are not on one line";
  if (reference.size() < 3) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("the trajectory cannot be aligned: {} matched positions", reference.size()),
                hint);
  }
  const Vector3d reference_center = centroid(reference);
  const Vector3d estimate_center = centroid(estimate);
  Matrix3d covariance = Matrix3d::Zero();
  for (std::size_t i = 0; i < reference.size(); ++i) {
    covariance += (reference[i] - reference_center) * (estimate[i] - estimate_center).transpose();
  }
  const Eigen::JacobiSVD<Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d singular = svd.singularValues();
  // Written so that NaN and all-zero fail.
  if (!(singular[1] > kRankTolerance * singular[0])) {
    return fail(
        ErrorCode::data_corrupt,
        fmt::format("the trajectory cannot be aligned: its {} matched positions lie on a line or in a point "
                    "(singular values {:.3g}, {:.3g}, {:.3g})",
                    reference.size(), singular[0], singular[1], singular[2]),
        hint);
  }
  Vector3d signs = Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;  // no reflections
  const Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  SE3 T_reference_estimate;
  T_reference_estimate.rotation = Quaterniond(rotation).normalized();
  T_reference_estimate.translation = reference_center - T_reference_estimate.rotation * estimate_center;
  return T_reference_estimate;
}

}  // namespace fusebench
