// Scatter of sums over a recording whose errors are common to a period of it or to a part of the image.
#pragma once

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cstddef>
#include <vector>

namespace fusebench::inspection::measures {

/// Sums by period of the recording and cell of the image. All periods have the same number of cells.
template <typename T>
using Grid = std::vector<std::vector<T>>;

/// Covariance of the sum of a grid of vectors with mean zero, whose errors may be common to a period or to a
/// cell: V_periods + V_cells - V_both (Cameron, Gelbach and Miller 2011), without negative eigenvalues.
template <int N>
[[nodiscard]] Eigen::Matrix<double, N, N> clustered_covariance(
    const Grid<Eigen::Matrix<double, N, 1>>& grid) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;
  const auto scatter = [](const std::vector<Vector>& sums) {
    Matrix out = Matrix::Zero();
    for (const Vector& sum : sums) out += sum * sum.transpose();
    const auto count = static_cast<double>(sums.size());
    return Matrix(out * (count / std::max(1.0, count - 1)));
  };
  std::vector<Vector> periods(grid.size(), Vector::Zero()), cells(grid.front().size(), Vector::Zero()), both;
  for (std::size_t period = 0; period < grid.size(); ++period) {
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      periods[period] += grid[period][cell];
      cells[cell] += grid[period][cell];
      both.push_back(grid[period][cell]);
    }
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(scatter(periods) + scatter(cells) - scatter(both));
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() *
         eigen.eigenvectors().transpose();
}

/// Sum over a grid that is not empty.
template <typename T>
[[nodiscard]] T sum_of(const Grid<T>& grid) {
  T sum = grid.front().front();
  sum.setZero();
  for (const std::vector<T>& cells : grid) {
    for (const T& cell : cells) sum += cell;
  }
  return sum;
}

}  // namespace fusebench::inspection::measures
