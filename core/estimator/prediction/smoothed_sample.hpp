// Inertial samples around an instant and their smoothed value there, for derivatives by time.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/types.hpp"

namespace fusebench::prediction {

/// The samples (sorted by time) within half_window_s of the instant.
[[nodiscard]] std::span<const ImuSample> samples_around(std::span<const ImuSample> samples,
                                                        std::int64_t instant_ns, double half_window_s);

/// Value at the instant of the least-squares parabola through the samples within half_window_s (Savitzky &
/// Golay 1964). Over 0.1 s it attenuates motion of 3 Hz by a sixth. With fewer than two samples on either
/// side, the nearest sample. Requires at least one sample.
[[nodiscard]] ImuSample smoothed_sample(std::span<const ImuSample> samples, std::int64_t instant_ns,
                                        double half_window_s);

}  // namespace fusebench::prediction
