// Sparse matrices of Eigen that share no code with those in Ceres.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>

namespace fusebench {
inline namespace base {

/// Indices of 64 bits, unlike those in Ceres: Debian builds that library (a static one) without AVX, the
/// linker keeps one copy of every function that both use, and memory of one alignment must not be freed as
/// another.
using SparseIndex = std::ptrdiff_t;
using SparseMatrixd = Eigen::SparseMatrix<double, Eigen::ColMajor, SparseIndex>;
using SparseRowsd = Eigen::SparseMatrix<double, Eigen::RowMajor, SparseIndex>;

}  // namespace base
}  // namespace fusebench
