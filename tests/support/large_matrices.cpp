#include "tests/support/large_matrices.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace fusebench::testing {

using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// One form of a product and one decomposition for all: each further one takes seconds to compile.
MatrixXd transposed(const MatrixXd& matrix) { return matrix.transpose(); }

MatrixXd identity(Eigen::Index size) { return MatrixXd::Identity(size, size); }

}  // namespace

double distance(const MatrixXd& a, const MatrixXd& b) { return (a - b).norm(); }

double relative_distance(const MatrixXd& a, const MatrixXd& b) { return distance(a, b) / b.norm(); }

double largest_difference(const MatrixXd& a, const MatrixXd& b) { return (a - b).cwiseAbs().maxCoeff(); }

MatrixXd product(const MatrixXd& a, const MatrixXd& b) { return a.lazyProduct(b); }

MatrixXd carried(const MatrixXd& jacobian, const MatrixXd& covariance) {
  return product(product(jacobian, covariance), transposed(jacobian));
}

MatrixXd root_information(const MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(covariance);
  MatrixXd rows = transposed(eigen.eigenvectors());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) rows.row(i) /= std::sqrt(eigen.eigenvalues()[i]);
  return rows;
}

MatrixXd inverse(const MatrixXd& symmetric) {
  const MatrixXd root = root_information(symmetric);
  return product(transposed(root), root);
}

double normalised(const VectorXd& error, const MatrixXd& covariance) {
  const double norm = product(root_information(covariance), error).norm();
  return norm * norm;
}

double smallest_eigenvalue(const MatrixXd& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixXd>(symmetric).eigenvalues().minCoeff();
}

MatrixXd kalman_gain(const MatrixXd& covariance, const MatrixXd& H, const MatrixXd& noise) {
  return product(product(covariance, transposed(H)), inverse(carried(H, covariance) + noise));
}

MatrixXd joseph(const MatrixXd& covariance, const MatrixXd& gain, const MatrixXd& H, const MatrixXd& noise) {
  return carried(identity(covariance.rows()) - product(gain, H), covariance) + carried(gain, noise);
}

MatrixXd after_update(const MatrixXd& covariance, const MatrixXd& gain, const MatrixXd& H) {
  return product(identity(covariance.rows()) - product(gain, H), covariance);
}

}  // namespace fusebench::testing
