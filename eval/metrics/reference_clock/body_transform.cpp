#include "eval/metrics/reference_clock/body_transform.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <numbers>

namespace fusebench::reference_clock {

namespace {

constexpr double kPriorOffset_m = 1.0;
constexpr double kPriorScale = 0.3;
constexpr double kPriorRotation_rad = std::numbers::pi;

/// The rotation R that maximises trace(R^T C).
Quaterniond nearest_rotation(const Matrix3d& correlation) {
  const Eigen::JacobiSVD<Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d signs = Vector3d::Ones();
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0) signs.z() = -1;
  return Quaterniond(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose()).normalized();
}

Quaterniond fitted_rotation(std::span<const MotionPair> pairs, std::span<const double> weights,
                            const MotionSigmas& sigmas, const BodyTransform& at) {
  Matrix3d correlation = Matrix3d::Zero();
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [reference, estimated] = pairs[k];
    const Vector3d moved_m = reference.translation - at.offset_m + reference.rotation * at.offset_m;
    correlation += weights[k] / (sigmas.rotation_rad * sigmas.rotation_rad) * so3_log(reference.rotation) *
                   so3_log(estimated.rotation).transpose();
    correlation += weights[k] / (sigmas.translation_m * sigmas.translation_m) * moved_m *
                   (at.scale * estimated.translation).transpose();
  }
  return nearest_rotation(correlation);
}

/// o and s of a given R.
void fit_offset_and_scale(std::span<const MotionPair> pairs, std::span<const double> weights,
                          const MotionSigmas& sigmas, BodyTransform& transform) {
  Eigen::Matrix4d information = prior_information().bottomRightCorner<4, 4>();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  right(3) = information(3, 3);  // s = 1
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto& [reference, estimated] = pairs[k];
    Eigen::Matrix<double, 3, 4> columns;
    columns.leftCols<3>() = Matrix3d::Identity() - reference.rotation_matrix();
    columns.col(3) = transform.rotation * estimated.translation;
    const double weight = weights[k] / (sigmas.translation_m * sigmas.translation_m);
    information += weight * columns.transpose() * columns;
    right += weight * columns.transpose() * reference.translation;
  }
  const Eigen::Vector4d solution = information.ldlt().solve(right);
  transform.offset_m = solution.head<3>();
  transform.scale = solution(3);
}

}  // namespace

SE3 BodyTransform::operator()(const SE3& estimated) const {
  const Quaterniond turned = (rotation * estimated.rotation * rotation.conjugate()).normalized();
  return {turned, scale * (rotation * estimated.translation) + offset_m - turned * offset_m};
}

BodyJacobian BodyTransform::jacobian(const SE3& estimated) const {
  const Matrix3d turned = (rotation * estimated.rotation * rotation.conjugate()).toRotationMatrix();
  const Vector3d moved_m = rotation * estimated.translation;
  const Matrix3d by_rotation = turned.transpose() - Matrix3d::Identity();
  BodyJacobian jacobian = BodyJacobian::Zero();
  jacobian.topLeftCorner<3, 3>() = by_rotation;
  jacobian.bottomLeftCorner<3, 3>() = turned * hat(offset_m) * by_rotation - scale * hat(moved_m);
  jacobian.block<3, 3>(3, 3) = Matrix3d::Identity() - turned;
  jacobian.bottomRightCorner<3, 1>() = moved_m;
  return jacobian;
}

void BodyTransform::step(const Vector7d& delta) {
  rotation = (so3_exp(delta.head<3>()) * rotation).normalized();
  offset_m += delta.segment<3>(3);
  scale += delta(6);
}

BodyTransform rough_transform(std::span<const MotionPair> pairs, std::span<const double> weights,
                              const MotionSigmas& sigmas) {
  constexpr int kRounds = 2;
  BodyTransform transform;
  for (int round = 0; round < kRounds; ++round) {
    transform.rotation = fitted_rotation(pairs, weights, sigmas, transform);
    fit_offset_and_scale(pairs, weights, sigmas, transform);
  }
  return transform;
}

Matrix7d prior_information() {
  Vector7d sigmas;
  sigmas << Vector3d::Constant(kPriorRotation_rad), Vector3d::Constant(kPriorOffset_m), kPriorScale;
  return Matrix7d(sigmas.cwiseAbs2().cwiseInverse().asDiagonal());
}

Vector7d prior_gradient(const BodyTransform& transform) {
  Vector7d off = Vector7d::Zero();
  off.segment<3>(3) = transform.offset_m;
  off(6) = transform.scale - 1;
  return prior_information() * off;
}

}  // namespace fusebench::reference_clock
