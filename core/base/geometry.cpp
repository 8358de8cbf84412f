#include "core/base/geometry.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/solvers.hpp"

namespace fusebench {
inline namespace base {

namespace {
// Below this angle the series is exact to double precision, and the closed form would divide 0 by 0.
constexpr double kSmallAngleRad = 1e-5;
}  // namespace

Matrix3d hat(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

Quaterniond so3_exp(const Vector3d& phi_rad) {
  const double angle = phi_rad.norm();
  const double half = 0.5 * angle;
  const double scale = angle < kSmallAngleRad ? 0.5 - angle * angle / 48.0 : std::sin(half) / angle;
  const Vector3d v = scale * phi_rad;
  return Quaterniond(std::cos(half), v.x(), v.y(), v.z()).normalized();
}

Vector3d so3_log(const Quaterniond& rotation) {
  Quaterniond q = rotation;
  if (q.w() < 0) q.coeffs() *= -1.0;  // q and -q are the same rotation; w >= 0 gives the shorter one
  const double sine = q.vec().norm();
  if (sine < kSmallAngleRad) return 2.0 * q.vec() / q.w();
  return 2.0 * std::atan2(sine, q.w()) / sine * q.vec();
}

Matrix3d so3_right_jacobian(const Vector3d& phi_rad) {
  const double angle = phi_rad.norm();
  const Matrix3d k = hat(phi_rad);
  if (angle < kSmallAngleRad) return Matrix3d::Identity() - 0.5 * k + k * k / 6.0;
  const double a2 = angle * angle;
  return Matrix3d::Identity() - (1.0 - std::cos(angle)) / a2 * k +
         (angle - std::sin(angle)) / (a2 * angle) * k * k;
}

double largest_sigma(const Matrix3d& covariance) {
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvalues().maxCoeff());
}

double rotation_angle_rad(const Quaterniond& a, const Quaterniond& b) {
  return so3_log(a.conjugate() * b).norm();
}

SE3 pose_plus(const SE3& pose, const Vector6d& tangent) {
  return {(pose.rotation * so3_exp(tangent.head<3>())).normalized(), pose.translation + tangent.tail<3>()};
}

Vector6d pose_minus(const SE3& to, const SE3& from) {
  Vector6d tangent;
  tangent << so3_log(from.rotation.conjugate() * to.rotation), to.translation - from.translation;
  return tangent;
}

Matrix6d with_position_in(const Quaterniond& R_b_a, const Matrix6d& covariance) {
  Matrix6d turn = Matrix6d::Identity();
  turn.bottomRightCorner<3, 3>() = R_b_a.toRotationMatrix();
  return turn * covariance * turn.transpose();
}

SE3 interpolate(const SE3& a, const SE3& b, double fraction) {
  return {(a.rotation * so3_exp(fraction * so3_log(a.rotation.conjugate() * b.rotation))).normalized(),
          a.translation + fraction * (b.translation - a.translation)};
}

Matrix3x2d s2_basis(const Vector3d& direction) {
  // Gram-Schmidt with the least aligned axis; the lower index on a tie.
  int axis = 0;
  direction.cwiseAbs().minCoeff(&axis);
  const Vector3d first = direction.cross(Vector3d::Unit(axis)).normalized();
  Matrix3x2d basis;
  basis.col(0) = first;
  basis.col(1) = direction.cross(first);
  return basis;
}

Vector3d s2_plus(const Vector3d& direction, const Vector2d& delta_rad) {
  return (so3_exp(s2_basis(direction) * delta_rad) * direction).normalized();
}

Vector2d s2_minus(const Vector3d& to, const Vector3d& from) {
  const Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double angle = std::atan2(sine, from.dot(to));
  if (sine < 1e-12) return Vector2d::Zero();  // equal, or opposite (where the direction is undefined)
  return s2_basis(from).transpose() * (angle / sine * axis);
}

}  // namespace base
}  // namespace fusebench
