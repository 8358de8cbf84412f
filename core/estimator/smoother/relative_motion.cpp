#include "core/estimator/smoother/relative_motion.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/solvers.hpp"

namespace fusebench::smoother {

namespace {

/// Inverse of the information without unobservable directions.
Matrix6d inverse_of_known(const Eigen::SelfAdjointEigenSolver<Matrix6d>& eigen, double least) {
  Matrix6d inverse = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const Vector6d direction = eigen.eigenvectors().col(i);
    if (eigen.eigenvalues()[i] > least) inverse += direction * direction.transpose() / eigen.eigenvalues()[i];
  }
  return inverse;
}

constexpr double kMinInformation = 1.0;  // 1 rad, 1 m

}  // namespace

VisualPose visual_pose(const health::PoseEvidence& evidence, const SE3& T_imu_camera) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(evidence.quadratic.information);
  const Matrix6d known = inverse_of_known(eigen, kMinInformation);
  const Vector6d step = -known * evidence.quadratic.gradient;
  Matrix6d covariance = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double information = eigen.eigenvalues()[i];
    const Vector6d direction = eigen.eigenvectors().col(i);
    covariance += direction * direction.transpose() / std::max(information, kMinInformation);
  }
  const SE3 T_world_imu{(evidence.T_world_imu.rotation * so3_exp(step.head<3>())).normalized(),
                        evidence.T_world_imu.translation + step.tail<3>()};

  Matrix6d camera_by_imu = Matrix6d::Identity();
  camera_by_imu.topLeftCorner<3, 3>() = T_imu_camera.rotation_matrix().transpose();
  camera_by_imu.bottomLeftCorner<3, 3>() = -T_world_imu.rotation_matrix() * hat(T_imu_camera.translation);
  return {T_world_imu * T_imu_camera, camera_by_imu * covariance * camera_by_imu.transpose(),
          evidence.timing.timing_s, -camera_by_imu * known * evidence.timing.with_pose};
}

VisualTiming visual_timing(const health::PoseEvidence& evidence) {
  constexpr double kLeast = 1.0;  // 1 s
  const filter::PoseTimingQuadratic& timing = evidence.timing;
  const Matrix6d known = inverse_of_known(
      Eigen::SelfAdjointEigenSolver<Matrix6d>(evidence.quadratic.information), kMinInformation);
  const Matrix3d information = timing.information - timing.with_pose.transpose() * known * timing.with_pose;
  const Vector3d gradient =
      timing.gradient - timing.with_pose.transpose() * known * evidence.quadratic.gradient;
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(information);
  VisualTiming result;
  result.timing_s = timing.timing_s;
  for (int i = 0; i < 3; ++i) {
    if (eigen.eigenvalues()[i] <= kLeast) continue;
    const double root = std::sqrt(eigen.eigenvalues()[i]);
    const Vector3d direction = eigen.eigenvectors().col(i);
    result.root += root * direction * direction.transpose();
    result.residual += direction * (direction.dot(gradient) / root);
    ++result.rank;
  }
  return result;
}

RelativeCameraMotion motion_between(const VisualPose& reference, const VisualPose& camera) {
  const SE3 T_world_reference = pose_plus(
      reference.T_world_camera, Vector6d(reference.by_timing * (camera.timing_s - reference.timing_s)));
  RelativeCameraMotion motion;
  motion.T_reference_camera = T_world_reference.inverse() * camera.T_world_camera;
  const Matrix3d R_reference_world = T_world_reference.rotation_matrix().transpose();
  Matrix6d by_camera = Matrix6d::Identity();
  by_camera.bottomRightCorner<3, 3>() = R_reference_world;
  Matrix6d by_reference = Matrix6d::Zero();
  by_reference.topLeftCorner<3, 3>() = -motion.T_reference_camera.rotation_matrix().transpose();
  by_reference.bottomLeftCorner<3, 3>() = hat(motion.T_reference_camera.translation);
  by_reference.bottomRightCorner<3, 3>() = -R_reference_world;
  motion.covariance = by_camera * camera.covariance * by_camera.transpose() +
                      by_reference * reference.covariance * by_reference.transpose();
  motion.timing_s = camera.timing_s;
  motion.by_timing = by_camera * camera.by_timing + by_reference * reference.by_timing;
  return motion;
}

Matrix6d whitening(const RelativeCameraMotion& motion) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(motion.covariance);
  return eigen.operatorInverseSqrt();
}

}  // namespace fusebench::smoother
