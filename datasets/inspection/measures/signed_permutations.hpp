// The 48 ways in which the axes of a sensor may be exchanged and reversed.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "core/base/types.hpp"

namespace fusebench::inspection::measures {

/// All signed permutation matrices. The 24 rotations first; within both halves those that change fewer axes
/// first, so that the first one is the identity.
[[nodiscard]] std::span<const Matrix3d> signed_permutations();
inline constexpr std::size_t kProperPermutations = 24;

/// What rows of names become under a matrix: "(y, -x, z)". The names of `negative` replace "-name" where they
/// are given: "(right, up, back)".
[[nodiscard]] std::string permutation_text(const Matrix3d& permutation,
                                           const std::array<std::string_view, 3>& names = {"x", "y", "z"},
                                           const std::array<std::string_view, 3>& negative = {});

/// One of the 48, chosen by the sums of squared residuals that each of them leaves.
struct AxesChoice {
  std::size_t index = 0;   ///< into signed_permutations()
  double ratio = 1;        ///< of its rms residual to that of the axes as given
  bool is_clear = false;   ///< clearly better than the axes as given
  bool is_unique = false;  ///< and clearly better than all others
};

/// `costs` are sums of squared residuals, one for each of the first costs.size() permutations; `given` is the
/// index of the axes as they are read. A permutation is clearly better than another if it leaves at most half
/// of the squared residuals, and if the likelihood ratio of both (freedom / 2 * log of the ratio of the
/// squared residuals) exceeds the logarithm of the number of alternatives over a probability of 0.1 %.
[[nodiscard]] AxesChoice choose_axes(std::span<const double> costs, std::size_t given, double freedom);

}  // namespace fusebench::inspection::measures
