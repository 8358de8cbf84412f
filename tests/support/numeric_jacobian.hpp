// Numeric derivatives by central differences, to check analytic ones against.
#pragma once

#include <Eigen/Core>

namespace fusebench::testing {

/// d f(e) / d e at e = 0 for f: R^n -> R^m given as vectors; step in the unit of e.
template <class Function>
Eigen::MatrixXd numeric_jacobian(const Function& f, int n, double step = 1e-6) {
  Eigen::MatrixXd jacobian;
  for (int i = 0; i < n; ++i) {
    Eigen::VectorXd e = Eigen::VectorXd::Zero(n);
    e[i] = step;
    const Eigen::VectorXd plus = f(e);
    e[i] = -step;
    const Eigen::VectorXd minus = f(e);
    if (jacobian.size() == 0) jacobian.resize(plus.size(), n);
    jacobian.col(i) = (plus - minus) / (2.0 * step);
  }
  return jacobian;
}

/// Largest difference relative to the size of the entries (at least 1).
inline double relative_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / std::max(1.0, b.cwiseAbs().maxCoeff());
}

}  // namespace fusebench::testing
