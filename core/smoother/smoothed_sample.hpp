// Inertial samples without most of their noise, for derivatives by time.
#pragma once

#include <cstdint>
#include <span>

#include "core/imu_preintegration.hpp"
#include "core/types.hpp"

namespace fusebench {

/// The value at the instant of the parabola that fits the samples within half_window_s best (Savitzky & Golay
/// 1964); over 0.1 s it follows motion of 3 Hz to a sixth. With fewer than four samples there, the nearest
/// one. There must be a sample.
[[nodiscard]] ImuSample smoothed_sample(std::span<const ImuSample> samples, std::int64_t instant_ns,
                                        double half_window_s);

/// Replaces the derivatives of an increment by the offset of the clock, which preintegrate() takes from
/// single samples at both ends. Where a camera moves slowly these are mostly noise, and since the same noise
/// is in the increments, an estimate of the offset that trusts them is biased and too sure of itself. begin
/// and end: smoothed, biases removed.
void differentiate_by_time_offset(PreintegratedImu& imu, const ImuSample& begin, const ImuSample& end);

}  // namespace fusebench
