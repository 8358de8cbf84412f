// How often tracking fails at which angular speed of the camera (docs/metrics.md, "Failures by angular
// speed").
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "eval/metrics/trajectory_error/silent_failures.hpp"

namespace fusebench::speed_failures {

/// Width of a bin.
inline constexpr double kSpeedBin_degps = 50;

/// Frames of one bin of angular speed.
struct SpeedBin {
  std::size_t frames = 0;
  std::size_t lost = 0;    ///< without a pose
  std::size_t silent = 0;  ///< with a pose that is an undetected failure

  SpeedBin& operator+=(const SpeedBin& other);
};

/// Bin i has the frames before which the camera turned by i to i + 1 times kSpeedBin_degps at its fastest:
/// the largest mean over 0.1 s, within limits.interval_s, of the ground truth. frames_ns: stamps of all
/// frames, sorted. A frame that is neither lost nor judged (silent_failures()), or about whose motion the
/// truth tells nothing, is in no bin.
[[nodiscard]] std::vector<SpeedBin> failures_by_speed(
    const Trajectory& ground_truth, std::span<const std::int64_t> frames_ns, const Trajectory& estimate,
    const trajectory_error::SilentFailureLimits& limits = {});

}  // namespace fusebench::speed_failures
