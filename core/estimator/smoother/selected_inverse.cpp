#include "core/estimator/smoother/selected_inverse.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::smoother {

std::optional<SelectedInverse> SelectedInverse::of(const SparseMatrixd& matrix) {
  auto factor = std::make_shared<Factor>(matrix);
  if (factor->info() != Eigen::Success || !(factor->vectorD().minCoeff() > 0)) return std::nullopt;
  return SelectedInverse(std::move(factor));
}

SelectedInverse::SelectedInverse(std::shared_ptr<const Factor> factor) : factor_(std::move(factor)) {
  const SparseMatrixd below = factor_->matrixL().nestedExpression();
  SparseMatrixd unit(below.rows(), below.cols());
  unit.setIdentity();
  inverse_ = below + unit;  // pattern of the factor; a column has the factor's values until it is computed
  inverse_.makeCompressed();
  for (Eigen::Index column = inverse_.cols() - 1; column >= 0; --column) fill_column(column);
}

/// Z = D^-1 L^-1 + (I - L^T) Z, from the last column to the first: an entry of a column needs only entries of
/// later columns within the pattern.
void SelectedInverse::fill_column(Eigen::Index column) {
  const SparseIndex* outer = inverse_.outerIndexPtr();
  const SparseIndex* inner = inverse_.innerIndexPtr();
  double* value = inverse_.valuePtr();
  const SparseIndex begin = outer[column] + 1;  // below the diagonal
  const SparseIndex end = outer[column + 1];
  const std::vector<double> factor(value + begin, value + end);
  std::vector<double> sum(factor.size(), 0.0);
  for (SparseIndex k = begin; k < end; ++k) {
    SparseIndex at =
        outer[inner[k]];  // advances in column inner[k], whose rows include those of this column below
    const auto of_k = static_cast<std::size_t>(k - begin);
    for (SparseIndex i = k; i < end; ++i) {
      while (inner[at] < inner[i]) ++at;
      const auto of_i = static_cast<std::size_t>(i - begin);
      sum[of_i] += factor[of_k] * value[at];
      if (i != k) sum[of_k] += factor[of_i] * value[at];
    }
  }
  double diagonal = 1.0 / factor_->vectorD()[column];
  for (SparseIndex i = begin; i < end; ++i) {
    const auto of_i = static_cast<std::size_t>(i - begin);
    value[i] = -sum[of_i];
    diagonal += factor[of_i] * sum[of_i];
  }
  value[begin - 1] = diagonal;
}

double SelectedInverse::entry(Eigen::Index row, Eigen::Index column) const {
  const auto& order = factor_->permutationP().indices();
  const auto [low, high] = std::minmax(order[row], order[column]);
  const SparseIndex* begin = inverse_.innerIndexPtr() + inverse_.outerIndexPtr()[low];
  const SparseIndex* end = inverse_.innerIndexPtr() + inverse_.outerIndexPtr()[low + 1];
  const SparseIndex* found = std::lower_bound(begin, end, high);
  check(found != end && *found == high, "the entry of the inverse is among the selected ones");
  return inverse_.valuePtr()[found - inverse_.innerIndexPtr()];
}

Eigen::MatrixXd SelectedInverse::block(Eigen::Index row, Eigen::Index column, Eigen::Index rows,
                                       Eigen::Index columns) const {
  Eigen::MatrixXd result(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) result(i, j) = entry(row + i, column + j);
  }
  return result;
}

Eigen::MatrixXd SelectedInverse::columns(const Eigen::MatrixXd& unit_columns) const {
  return factor_->solve(unit_columns);
}

}  // namespace fusebench::smoother
