// Numerical validity of a filter state. A single corrupt inertial sample can make it diverge.
#pragma once

#include "core/filter/filter_state.hpp"

namespace fusebench::filter {

/// Mean beyond which the arithmetic no longer resolves a room: the kernels are of single precision, whose
/// step is a millimetre at 10 km (2^-10 m from 2^13 m on). Velocities (10 km/s, krad/s) are of no camera
/// either.
inline constexpr double kMaxMean = 1e4;
/// Variance beyond which an update, which takes the difference of two such, no longer resolves a millimetre
/// in double precision (1e-16 of 1e9 is a third of a millimetre, squared).
inline constexpr double kMaxVariance = 1e9;

/// Scale errors of an IMU, and errors of its timing, that no sensor has: there is something else.
inline constexpr double kMaxScale = 0.5;
inline constexpr double kMaxTiming_s = 1.0;

/// True if mean and covariance are finite and within these bounds.
[[nodiscard]] bool is_valid(const GaussianState& state);

}  // namespace fusebench::filter
