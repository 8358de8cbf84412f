// Entries of the inverse of a sparse matrix without the whole inverse: variances of large least-squares
// problems.
#pragma once

#include <Eigen/SparseCholesky>
#include <memory>
#include <optional>

#include "core/base/sparse_matrix.hpp"

namespace fusebench::smoother {

/// The inverse of a symmetric positive definite matrix, at all entries where its Cholesky factor is not zero
/// by structure (Takahashi's recursion; Erisman & Tinney 1975). That includes the pattern of the matrix, so
/// the covariance of any two unknowns of a common residual is available.
class SelectedInverse {
 public:
  /// Only the lower triangle is read. Nothing if the matrix is not positive definite.
  [[nodiscard]] static std::optional<SelectedInverse> of(const SparseMatrixd& matrix);

  /// The entry, which must be one of those above (see check()).
  [[nodiscard]] double entry(Eigen::Index row, Eigen::Index column) const;
  /// A block of entries of the inverse, all of which must be there.
  [[nodiscard]] Eigen::MatrixXd block(Eigen::Index row, Eigen::Index column, Eigen::Index rows,
                                      Eigen::Index columns) const;
  /// Whole columns of the inverse, from the factor.
  [[nodiscard]] Eigen::MatrixXd columns(const Eigen::MatrixXd& unit_columns) const;

 private:
  using Factor = Eigen::SimplicialLDLT<SparseMatrixd, Eigen::Lower, Eigen::AMDOrdering<SparseIndex>>;

  explicit SelectedInverse(std::shared_ptr<const Factor> factor);
  void fill_column(Eigen::Index column);

  std::shared_ptr<const Factor> factor_;
  SparseMatrixd inverse_;  ///< lower triangle in the order of the factor
};

}  // namespace fusebench::smoother
