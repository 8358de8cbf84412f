// Numerical validity of a filter state. One corrupt inertial sample can make it diverge.
#pragma once

#include "core/estimator/filter/filter_state.hpp"

namespace fusebench::filter {

/// Largest valid mean. The kernels are of single precision, whose resolution is a millimetre at 10 km (2^-10
/// m above 2^13 m). Velocities of 10 km/s or krad/s are not plausible either.
inline constexpr double kMaxMean = 1e4;
/// Largest valid variance. An update subtracts two such values; with a relative precision of 1e-16 the
/// difference of larger ones would not resolve (1 mm)^2.
inline constexpr double kMaxVariance = 1e9;

/// Largest plausible scale and timing errors of a sensor.
inline constexpr double kMaxScale = 0.5;
inline constexpr double kMaxTiming_s = 1.0;

/// True if mean and covariance are finite and within these limits.
[[nodiscard]] bool is_valid(const GaussianState& state);

}  // namespace fusebench::filter
