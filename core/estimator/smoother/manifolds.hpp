// Manifolds for Ceres with the perturbations of core/estimator/filter/filter_state.hpp: rotations R * Exp(d),
// unit directions by s2_plus. Quaternions are stored as in Eigen: x, y, z, w.
#pragma once

#include <ceres/manifold.h>

namespace fusebench::smoother {

/// Unit quaternions; tangent in rad, in the frame on the right.
class RotationManifold final : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 4; }
  [[nodiscard]] int TangentSize() const override { return 3; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

/// Unit vectors of R^3; tangent in rad, in the basis s2_basis().
class DirectionManifold final : public ceres::Manifold {
 public:
  [[nodiscard]] int AmbientSize() const override { return 3; }
  [[nodiscard]] int TangentSize() const override { return 2; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override;
  bool PlusJacobian(const double* x, double* jacobian) const override;
  bool Minus(const double* y, const double* x, double* y_minus_x) const override;
  bool MinusJacobian(const double* x, double* jacobian) const override;
};

}  // namespace fusebench::smoother
