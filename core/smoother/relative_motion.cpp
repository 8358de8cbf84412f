#include "core/smoother/relative_motion.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace fusebench::smoother {

VisualPose visual_pose(const health::PoseEvidence& evidence, const SE3& T_imu_camera) {
  constexpr double kMinInformation = 1.0;  // 1 rad, 1 m
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(evidence.quadratic.information);
  Vector6d step = Vector6d::Zero();
  Matrix6d covariance = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    const double information = eigen.eigenvalues()[i];
    const Vector6d direction = eigen.eigenvectors().col(i);
    covariance += direction * direction.transpose() / std::max(information, kMinInformation);
    if (information > kMinInformation)
      step -= direction * direction.dot(evidence.quadratic.gradient) / information;
  }
  const SE3 T_world_imu{(evidence.T_world_imu.rotation * so3_exp(step.head<3>())).normalized(),
                        evidence.T_world_imu.translation + step.tail<3>()};

  Matrix6d camera_by_imu = Matrix6d::Identity();
  camera_by_imu.topLeftCorner<3, 3>() = T_imu_camera.rotation_matrix().transpose();
  camera_by_imu.bottomLeftCorner<3, 3>() = -T_world_imu.rotation_matrix() * hat(T_imu_camera.translation);
  return {T_world_imu * T_imu_camera, camera_by_imu * covariance * camera_by_imu.transpose()};
}

RelativeCameraMotion motion_between(const VisualPose& reference, const VisualPose& camera) {
  RelativeCameraMotion motion;
  motion.T_reference_camera = reference.T_world_camera.inverse() * camera.T_world_camera;
  const Matrix3d R_reference_world = reference.T_world_camera.rotation_matrix().transpose();
  Matrix6d by_camera = Matrix6d::Identity();
  by_camera.bottomRightCorner<3, 3>() = R_reference_world;
  Matrix6d by_reference = Matrix6d::Zero();
  by_reference.topLeftCorner<3, 3>() = -motion.T_reference_camera.rotation_matrix().transpose();
  by_reference.bottomLeftCorner<3, 3>() = hat(motion.T_reference_camera.translation);
  by_reference.bottomRightCorner<3, 3>() = -R_reference_world;
  motion.covariance = by_camera * camera.covariance * by_camera.transpose() +
                      by_reference * reference.covariance * by_reference.transpose();
  return motion;
}

Matrix6d whitening(const RelativeCameraMotion& motion) {
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(motion.covariance);
  return eigen.operatorInverseSqrt();
}

}  // namespace fusebench::smoother
