// The constant offset between the clocks of a reference and of an estimate.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::reference_clock {

/// t_reference = t_estimate + offset_s: the reference has at t_reference the pose that the estimate has at
/// t_estimate.
struct TimeOffset {
  double offset_s = 0;
  double sigma_s = 0;       ///< standard deviation
  std::size_t motions = 0;  ///< of the estimate that were compared

  /// |offset| > 5 sigma and > 10 ms. Smaller ones are as large as delays of filters and of the rows of an
  /// image.
  [[nodiscard]] bool significant() const;
};

/// A larger standard deviation is refused (seconds): within this TUM's protocol takes stamps for one instant,
/// so that an offset known less well improves nothing.
inline constexpr double kMostSigma_s = 0.02;

/// Compares motions over 0.5 s, A_k(d) of the reference at the estimate's stamps plus d, and B_k of the
/// estimate, which is X B_k X^-1 of the reference's body (BodyTransform: rotation, offset and scale, fitted
/// as well). The offset d is the root of
///
///   sum_k z_k^T W_k (A_k(d) - X B_k X^-1) = 0,
///
/// with z_k the rate of X B_k X^-1 from the estimate's motions 0.1 s before and after, X marginalised, and
/// W_k Huber's weights over variances. z_k has none of the noise of A_k and that of B_k symmetrically in
/// time, so that noise neither moves the root nor makes an offset observable. sigma_s^2 = V / (sum_k z_k^T
/// W_k dA_k/dd)^2 with V the correlated_variance() of the terms of the sum, plus that of decimals (0.1 mm and
/// 0.1 mrad).
///
/// Errors data_corrupt: fewer than 30 motions, or of less than 2.5 s (independent_terms()); a sigma above 20
/// ms (the motion does not make the offset observable); an offset beyond 0.5 s; several offsets that fit
/// alike. Deterministic, O(n log n); of more than 10,000 poses as many are used.
[[nodiscard]] Result<TimeOffset> fitted_time_offset(const Trajectory& reference, const Trajectory& estimate);

}  // namespace fusebench::reference_clock
