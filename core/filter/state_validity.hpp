// Whether the filter can go on from a state. One absurd inertial sample may carry it out of the numbers.
#pragma once

#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// Mean beyond which a state is of no camera in a room: 10 km, km/s or krad/s (SI units).
inline constexpr double kLargestMean = 1e4;
/// Variance beyond which an update, which takes the difference of two such, no longer resolves a millimetre
/// in double precision (1e-16 of 1e9 is a third of a millimetre, squared).
inline constexpr double kLargestVariance = 1e9;

/// True if mean and covariance are finite and within these bounds.
[[nodiscard]] bool is_valid(const GaussianState& state);

}  // namespace fusebench::filter
