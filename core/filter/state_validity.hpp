// Numerical validity of a filter state. A single corrupt inertial sample can make it diverge.
#pragma once

#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// Largest plausible component of the mean: 10 km, km/s or krad/s (SI units).
inline constexpr double kMaxMean = 1e4;
/// Variance beyond which an update, which subtracts two such numbers, no longer resolves a millimetre in
/// double precision (1e-16 of 1e9 is a third of a millimetre, squared).
inline constexpr double kMaxVariance = 1e9;

/// True if mean and covariance are finite and within these bounds.
[[nodiscard]] bool is_valid(const GaussianState& state);

}  // namespace fusebench::filter
