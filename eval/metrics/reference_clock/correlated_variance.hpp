// The variance of a sum of values whose errors are correlated in time.
#pragma once

#include <cstdint>
#include <span>

namespace fusebench::reference_clock {

/// A term of a sum.
struct StampedTerm {
  std::int64_t timestamp_ns = 0;
  double value = 0;        ///< of expectation 0
  double information = 0;  ///< what it adds to the information; not negative
};

/// Errors of trajectories are correlated over this long (seconds); terms further apart count as independent.
inline constexpr double kCorrelation_s = 1.0;

/// How many independent terms there are: (sum_s I_s)^2 / sum_s I_s^2 over the information I_s of each second.
/// As many as seconds where all hold as much, and 2 of 10 s of which the camera moves in 2. 0 without
/// information.
[[nodiscard]] double independent_terms(std::span<const StampedTerm> terms);

/// Variance of the sum of the values, where a fit has made that sum zero:
///
///   V = sum_ij max(0, 1 - |t_i - t_j| / L) v_i v_j / (1 - 1/n + 1/(3 n^2)) * n / (n - 2),   L = 1 s,
///
/// with n = independent_terms() and stamps in bins of 0.1 s: Bartlett's kernel (Newey and West 1987), its
/// bias for values of sum zero (Kiefer and Vogelsang 2005), and the variance of Student's t of n degrees of
/// freedom. Infinite for n <= 2. Stamps must not decrease. O(terms).
[[nodiscard]] double correlated_variance(std::span<const StampedTerm> terms);

}  // namespace fusebench::reference_clock
