// Eigen's sparse matrices with an index type that differs from that of Ceres.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>

namespace fusebench {
inline namespace base {

/// Ceres uses 32-bit indices. Debian builds its static library without AVX, and the linker would keep one
/// copy of every shared template function. Memory of one alignment would then be freed with another. 64-bit
/// indices keep the instances separate.
using SparseIndex = std::ptrdiff_t;
using SparseMatrixd = Eigen::SparseMatrix<double, Eigen::ColMajor, SparseIndex>;
using SparseRowsd = Eigen::SparseMatrix<double, Eigen::RowMajor, SparseIndex>;

}  // namespace base
}  // namespace fusebench
