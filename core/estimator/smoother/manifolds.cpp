#include "core/estimator/smoother/manifolds.hpp"

#include "core/base/geometry.hpp"

namespace fusebench::smoother {

namespace {

using RowMajor43 = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;
using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
using RowMajor32 = Eigen::Matrix<double, 3, 2, Eigen::RowMajor>;
using RowMajor23 = Eigen::Matrix<double, 2, 3, Eigen::RowMajor>;

Eigen::Map<const Quaterniond> quaternion(const double* x) { return Eigen::Map<const Quaterniond>(x); }
Eigen::Map<const Vector3d> vector(const double* x) { return Eigen::Map<const Vector3d>(x); }

/// d (q * Exp(d)) / dd at zero.
RowMajor43 rotation_by_tangent(const Quaterniond& q) {
  RowMajor43 jacobian;
  jacobian.topRows<3>() = 0.5 * (q.w() * Matrix3d::Identity() + hat(q.vec()));
  jacobian.bottomRows<1>() = -0.5 * q.vec().transpose();
  return jacobian;
}

/// d s2_plus(direction, d) / dd at zero; its columns are orthonormal.
RowMajor32 direction_by_tangent(const Vector3d& direction) { return -hat(direction) * s2_basis(direction); }

}  // namespace

bool RotationManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  Eigen::Map<Quaterniond> result(x_plus_delta);
  result = (quaternion(x) * so3_exp(vector(delta))).normalized();
  return true;
}

bool RotationManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor43> result(jacobian);
  result = rotation_by_tangent(quaternion(x));
  return true;
}

bool RotationManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector3d> result(y_minus_x);
  result = so3_log(quaternion(x).conjugate() * quaternion(y));
  return true;
}

bool RotationManifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor34> result(jacobian);
  result = 4.0 * rotation_by_tangent(quaternion(x)).transpose();
  return true;
}

bool DirectionManifold::Plus(const double* x, const double* delta, double* x_plus_delta) const {
  Eigen::Map<Vector3d> result(x_plus_delta);
  result = s2_plus(vector(x), Vector2d(delta[0], delta[1])).normalized();
  return true;
}

bool DirectionManifold::PlusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor32> result(jacobian);
  result = direction_by_tangent(vector(x));
  return true;
}

bool DirectionManifold::Minus(const double* y, const double* x, double* y_minus_x) const {
  Eigen::Map<Vector2d> result(y_minus_x);
  result = s2_minus(vector(y), vector(x));
  return true;
}

bool DirectionManifold::MinusJacobian(const double* x, double* jacobian) const {
  Eigen::Map<RowMajor23> result(jacobian);
  result = direction_by_tangent(vector(x)).transpose();
  return true;
}

}  // namespace fusebench::smoother
