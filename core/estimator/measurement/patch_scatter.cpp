#include "core/estimator/measurement/patch_scatter.hpp"

#include <algorithm>
#include <cmath>

#include "core/base/solvers.hpp"

namespace fusebench::measurement {

namespace {

/// Pseudo-inverse after scaling the diagonal to one, which makes radians and metres comparable.
Matrix6d scaled_pseudo_inverse(const Matrix6d& information) {
  constexpr double kMinShare = 1e-6;
  Vector6d scale = Vector6d::Zero();
  for (int i = 0; i < filter::kPoseSize; ++i) {
    if (information(i, i) > 0) scale[i] = 1.0 / std::sqrt(information(i, i));
  }
  const Matrix6d scaled = scale.asDiagonal() * information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled);
  Vector6d inverse = Vector6d::Zero();
  for (int i = 0; i < filter::kPoseSize; ++i) {
    if (eigen.eigenvalues()[i] > kMinShare) inverse[i] = 1.0 / eigen.eigenvalues()[i];
  }
  const Matrix6d& vectors = eigen.eigenvectors();
  return scale.asDiagonal() * (vectors * inverse.asDiagonal() * vectors.transpose()) * scale.asDiagonal();
}

}  // namespace

Scatter patch_scatter(std::span<const filter::PoseQuadratic> clusters) {
  Matrix6d information = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  for (const filter::PoseQuadratic& cluster : clusters) {
    information += cluster.information;
    gradient += cluster.gradient;
  }
  if (!(information.trace() > 0)) return {};
  const Matrix6d covariance = scaled_pseudo_inverse(information);
  const Vector6d optimum = -(covariance * gradient);
  // If gradients have the variance factor * information, the expected squared gradient of a cluster in the
  // metric of the covariance is factor * share, minus the reduction by the optimum itself.
  double scatter = 0, expected = 0, squared_influence = 0;
  for (const filter::PoseQuadratic& cluster : clusters) {
    const Vector6d left = cluster.gradient + cluster.information * optimum;
    const Matrix6d influence = covariance * cluster.information;
    scatter += left.dot(covariance * left);
    // trace of the squared influence
    const double squared = influence.cwiseProduct(influence.transpose()).sum();
    expected += influence.trace() - squared;
    squared_influence += squared;
  }
  if (!(expected > 1e-9)) return {};
  const double total = (covariance * information).trace();
  // Satterthwaite: degrees of freedom of a weighted sum of squares.
  return {scatter / expected, total * total / squared_influence};
}

double variance_factor(const Scatter& scatter, double prior_freedom) {
  const double freedom = prior_freedom + scatter.freedom;
  if (!(freedom > 0)) return 1.0;
  return std::max(kMinVarianceFactor, (prior_freedom + scatter.freedom * scatter.factor) / freedom);
}

}  // namespace fusebench::measurement
