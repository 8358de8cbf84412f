// Inertial samples around an instant, and their value there without most of its noise, for derivatives by
// time.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/types.hpp"

namespace fusebench::prediction {

/// Those of the samples (sorted by time) that are within half_window_s of the instant.
[[nodiscard]] std::span<const ImuSample> samples_around(std::span<const ImuSample> samples,
                                                        std::int64_t instant_ns, double half_window_s);

/// The value at the instant of the parabola that fits the samples within half_window_s best (Savitzky & Golay
/// 1964); over 0.1 s it follows motion of 3 Hz to a sixth. With fewer than two samples on either side,
/// the nearest one. There must be a sample.
[[nodiscard]] ImuSample smoothed_sample(std::span<const ImuSample> samples, std::int64_t instant_ns,
                                        double half_window_s);

}  // namespace fusebench::prediction
