#include "core/baselines/bundlefusion/residuals.hpp"

#include <cmath>

namespace fusebench::baselines::bundlefusion {

PointResidual point_residual(const SE3& T_world_a, const SE3& T_world_b, const PointPair& points) {
  PointResidual residual;
  residual.value_m = T_world_a * points.point_a - T_world_b * points.point_b;
  residual.by_pose_a << -T_world_a.rotation_matrix() * hat(points.point_a), Matrix3d::Identity();
  residual.by_pose_b << T_world_b.rotation_matrix() * hat(points.point_b), -Matrix3d::Identity();
  return residual;
}

RelativeMotion relative_motion(const SE3& T_world_a, const SE3& T_world_b) {
  const SE3 T_a_b = T_world_a.inverse() * T_world_b;
  const Matrix3d R_a_b = T_a_b.rotation_matrix();
  const Matrix3d R_a_world = T_world_a.rotation_matrix().transpose();
  RelativeMotion motion;
  motion.by_pose_a.topLeftCorner<3, 3>() = -Matrix3d::Identity();
  motion.by_pose_a.bottomRightCorner<3, 3>() = -R_a_world;
  motion.by_pose_b.topLeftCorner<3, 3>() = R_a_b;
  motion.by_pose_b.bottomLeftCorner<3, 3>() = hat(T_a_b.translation) * R_a_b;
  motion.by_pose_b.bottomRightCorner<3, 3>() = R_a_world;
  return motion;
}

Vector6d plane_direction(const Vector3d& point, const Vector3d& normal) {
  Vector6d direction;
  direction << point.cross(normal), normal;
  return direction;
}

PlaneSums plane_sums(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, double far_m) {
  PlaneSums sums;
  for_each_overlap(a, b, T_a_b,
                   [&](std::size_t cell, const Eigen::Vector3f& point, const Eigen::Vector3f& normal_b) {
                     const Eigen::Vector3f& surface = a.points.data[cell];
                     const Eigen::Vector3f& normal = a.normals.data[cell];
                     if (!are_of_one_surface(surface, normal, point, normal_b)) return;
                     ++sums.matches;
                     const double nearness = 1.0 - static_cast<double>(surface.z()) / far_m;
                     if (nearness <= 0) return;
                     const double weight = std::pow(nearness, 2.5);
                     const auto residual_m = static_cast<double>(normal.dot(surface - point));
                     const Vector6d direction = plane_direction(point.cast<double>(), normal.cast<double>());
                     sums.information.noalias() += (weight * direction) * direction.transpose();
                     sums.descent += (weight * residual_m) * direction;
                   });
  return sums;
}

}  // namespace fusebench::baselines::bundlefusion
