// Selected entries of the inverse of a sparse matrix: variances of large least-squares problems.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <optional>

#include "core/base/sparse_matrix.hpp"

namespace fusebench::smoother {

/// Entries of the inverse of a symmetric positive definite matrix at the structural nonzeros of its Cholesky
/// factor (Takahashi's recursion; Erisman & Tinney 1975). These include the pattern of the matrix, so the
/// covariance of any two unknowns with a common residual is available.
class SelectedInverse {
 public:
  /// Only the lower triangle is read. Nothing if the matrix is not positive definite.
  [[nodiscard]] static std::optional<SelectedInverse> of(const SparseMatrixd& matrix);

  /// An entry, which must be within the pattern (see check()).
  [[nodiscard]] double entry(Eigen::Index row, Eigen::Index column) const;
  /// A block of entries of the inverse, all within the pattern.
  [[nodiscard]] Eigen::MatrixXd block(Eigen::Index row, Eigen::Index column, Eigen::Index rows,
                                      Eigen::Index columns) const;
  /// Whole columns of the inverse, by solving with the factor.
  [[nodiscard]] Eigen::MatrixXd columns(const Eigen::MatrixXd& unit_columns) const;

 private:
  using Factor = Eigen::SimplicialLDLT<SparseMatrixd, Eigen::Lower, Eigen::AMDOrdering<SparseIndex>>;

  explicit SelectedInverse(std::shared_ptr<const Factor> factor);
  void fill_column(Eigen::Index column);

  std::shared_ptr<const Factor> factor_;
  SparseMatrixd inverse_;  ///< lower triangle, in the permuted order of the factor
};

}  // namespace fusebench::smoother
