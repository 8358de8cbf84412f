// Rotations, rigid transforms and directions.
//
// Convention: p_a = T_a_b * p_b, so adjacent frames cancel: T_a_c = T_a_b * T_b_c.
// Perturbations are on the right: R * Exp(phi), with phi in radians in the local (body) frame.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <numbers>

namespace fusebench {
inline namespace base {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix3x2d = Eigen::Matrix<double, 3, 2>;
using Matrix2x3d = Eigen::Matrix<double, 2, 3>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

inline constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
[[nodiscard]] constexpr double radians(double degrees) { return degrees * (std::numbers::pi / 180.0); }
[[nodiscard]] constexpr double degrees(double radians) { return radians * kDegreesPerRadian; }

/// Cross-product matrix: hat(a) * b = a x b.
[[nodiscard]] Matrix3d hat(const Vector3d& a);

/// Exponential of SO(3): rotation vector (rad) to unit quaternion (Rodrigues; series near zero).
[[nodiscard]] Quaterniond so3_exp(const Vector3d& phi_rad);

/// Logarithm of SO(3): the shortest rotation vector (rad), |phi| <= pi.
[[nodiscard]] Vector3d so3_log(const Quaterniond& rotation);

/// Right Jacobian: Exp(phi + d) = Exp(phi) * Exp(Jr(phi) d) + O(d^2) (Forster et al., T-RO 2017, Eq. 8).
[[nodiscard]] Matrix3d so3_right_jacobian(const Vector3d& phi_rad);

/// A rigid transform T_a_b: p_a = T_a_b * p_b.
struct SE3 {
  Quaterniond rotation = Quaterniond::Identity();  ///< unit quaternion, R_a_b
  Vector3d translation = Vector3d::Zero();         ///< origin of b in a, metres

  [[nodiscard]] SE3 inverse() const {
    const Quaterniond r = rotation.conjugate();
    return {r, -(r * translation)};
  }
  [[nodiscard]] SE3 operator*(const SE3& other) const {
    return {(rotation * other.rotation).normalized(), translation + rotation * other.translation};
  }
  [[nodiscard]] Vector3d operator*(const Vector3d& point) const { return rotation * point + translation; }
  [[nodiscard]] Matrix3d rotation_matrix() const { return rotation.toRotationMatrix(); }
};

/// Shortest rotation angle between two orientations, radians in [0, pi].
[[nodiscard]] double rotation_angle_rad(const Quaterniond& a, const Quaterniond& b);

/// Largest standard deviation of a covariance over all directions: the square root of its largest eigenvalue.
[[nodiscard]] double largest_sigma(const Matrix3d& covariance);

/// Perturbed pose: rotation R Exp(tangent[0..2] rad), position p + tangent[3..5] m.
[[nodiscard]] SE3 pose_plus(const SE3& pose, const Vector6d& tangent);

/// Inverse of pose_plus: the tangent d with from (+) d = to.
[[nodiscard]] Vector6d pose_minus(const SE3& to, const SE3& from);

/// Transforms a pose covariance (tangent of pose_plus) from a position in frame a to a position in frame b.
[[nodiscard]] Matrix6d with_position_in(const Quaterniond& R_b_a, const Matrix6d& covariance);

/// Interpolation from a (fraction 0) to b (fraction 1): geodesic rotation, linear translation.
[[nodiscard]] SE3 interpolate(const SE3& a, const SE3& b, double fraction);

/// Orthonormal basis (columns) of the plane orthogonal to a unit direction: the tangent of S2. A pure
/// function of the direction, with discontinuities where the reference axis changes.
[[nodiscard]] Matrix3x2d s2_basis(const Vector3d& direction);

/// Moves a unit direction by a tangent vector: Exp(B(direction) * delta) * direction. delta in radians.
[[nodiscard]] Vector3d s2_plus(const Vector3d& direction, const Vector2d& delta_rad);

/// Inverse of s2_plus: the delta with from (+) delta = to (both unit).
[[nodiscard]] Vector2d s2_minus(const Vector3d& to, const Vector3d& from);

}  // namespace base
}  // namespace fusebench
