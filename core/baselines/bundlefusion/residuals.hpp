// Residuals of the pose optimisation: distances of matched points and point-to-plane distances (Dai et al.
// 2017, Sec. 4.3, Eq. 3 and 4), with their derivatives.
//
// Tangents of poses are those of pose_plus(): rotation on the right (rad, camera), position (m, world).
#pragma once

#include <cstddef>

#include "core/baselines/bundlefusion/depth_cloud.hpp"
#include "core/baselines/bundlefusion/pair_filters.hpp"

namespace fusebench::baselines::bundlefusion {

using Matrix3x6d = Eigen::Matrix<double, 3, 6>;

/// A matched pair of points in the world: point a minus point b (metres).
struct PointResidual {
  Vector3d value_m = Vector3d::Zero();
  Matrix3x6d by_pose_a = Matrix3x6d::Zero();
  Matrix3x6d by_pose_b = Matrix3x6d::Zero();
};
[[nodiscard]] PointResidual point_residual(const SE3& T_world_a, const SE3& T_world_b,
                                           const PointPair& points);

/// A small motion of the points of b in the axes of a, p -> p + rotation x p + translation, with its
/// derivatives by both poses.
struct RelativeMotion {
  Matrix6d by_pose_a = Matrix6d::Zero();
  Matrix6d by_pose_b = Matrix6d::Zero();
};
[[nodiscard]] RelativeMotion relative_motion(const SE3& T_world_a, const SE3& T_world_b);

/// Negative derivative of normal . (surface - point) by such a motion; all in the axes of a.
[[nodiscard]] Vector6d plane_direction(const Vector3d& point, const Vector3d& normal);

/// Sums of the points of one depth image against the planes of another: information d = descent gives the
/// motion d that reduces the squared distances.
struct PlaneSums {
  Matrix6d information = Matrix6d::Zero();
  Vector6d descent = Vector6d::Zero();
  std::size_t matches = 0;
};

/// The weight of depth is (1 - depth_m / far_m)^2.5, and 0 from far_m on.
[[nodiscard]] PlaneSums plane_sums(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b, double far_m);

}  // namespace fusebench::baselines::bundlefusion
