// Algebra of matrices of any size, compiled once: with the sizes of the state, which are fixed, each
// expression becomes templates of its own, which take longer to compile than the tests to run.
#pragma once

#include <Eigen/Core>

namespace fusebench::testing {

/// |a - b|, the root of the sum of the squares of all entries; of vectors as well.
[[nodiscard]] double distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// The largest |a - b| of an entry.
[[nodiscard]] double largest_difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// distance(), in |b|.
[[nodiscard]] double relative_distance(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

[[nodiscard]] Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b);

/// J P J^T.
[[nodiscard]] Eigen::MatrixXd carried(const Eigen::MatrixXd& jacobian, const Eigen::MatrixXd& covariance);

/// Of a symmetric, positive definite matrix.
[[nodiscard]] Eigen::MatrixXd inverse(const Eigen::MatrixXd& symmetric);

/// e^T P^-1 e: chi-square distributed if P is the covariance of the error e.
[[nodiscard]] double normalised(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

/// An R with R^T R = P^-1.
[[nodiscard]] Eigen::MatrixXd root_information(const Eigen::MatrixXd& covariance);

[[nodiscard]] double smallest_eigenvalue(const Eigen::MatrixXd& symmetric);

/// What the textbook makes of a measurement z = H d + noise of the error d, of the covariance P: the gain
/// K = P H^T (H P H^T + U)^-1.
[[nodiscard]] Eigen::MatrixXd kalman_gain(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& H,
                                          const Eigen::MatrixXd& noise);

/// Joseph's form, (I - K H) P (I - K H)^T + K U K^T, which holds for any gain.
[[nodiscard]] Eigen::MatrixXd joseph(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& gain,
                                     const Eigen::MatrixXd& H, const Eigen::MatrixXd& noise);

/// (I - K H) P, which holds for the textbook's gain.
[[nodiscard]] Eigen::MatrixXd after_update(const Eigen::MatrixXd& covariance, const Eigen::MatrixXd& gain,
                                           const Eigen::MatrixXd& H);

}  // namespace fusebench::testing
