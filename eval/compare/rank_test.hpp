// Are the numbers of one group larger than those of another, or is it noise?
//
// The one-sided Mann-Whitney U test (Mann and Whitney, Annals of Mathematical Statistics 18, 1947; the
// correction for ties as in Hollander and Wolfe, Nonparametric Statistical Methods, section 4.1). It compares
// ranks, so that neither a slow outlier nor the shape of the noise decides.
#pragma once

#include <cstddef>
#include <span>

namespace fusebench::compare {

struct RankTest {
  double u = 0;        ///< pairs in which the later group is larger; a tie counts half
  double p = 1;        ///< of such a u or a larger one if both groups were of one distribution
  bool exact = false;  ///< the exact distribution, not its normal approximation
};

/// Tests whether `later` is larger than `earlier`. Exact up to 40 numbers without ties; beyond, the normal
/// approximation with the corrections for ties and continuity. p is 1 where a group is empty or all numbers
/// are equal. Numbers must be finite.
[[nodiscard]] RankTest test_larger(std::span<const double> earlier, std::span<const double> later);

/// The smallest p that groups of n numbers each can reach: with a smaller alpha a test never fires.
[[nodiscard]] double least_p(std::size_t n);

}  // namespace fusebench::compare
