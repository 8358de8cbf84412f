// Undetected failures: poses that an estimator claims and that are wrong (docs/metrics.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory_error {

/// What a claimed pose may be off by: the motion since the pose `interval_s` before.
struct SilentFailureLimits {
  double interval_s = 1.0;
  double max_translation_m = 0.05;
  double max_rotation_rad = 0.05235987755982988;  ///< 3 degrees
};

struct SilentFailures {
  SilentFailureLimits limits;
  std::size_t judged = 0;                ///< claimed poses for which the true motion is known
  std::size_t silent = 0;                ///< of these, off by more than the limits
  std::optional<std::int64_t> first_ns;  ///< stamp of the first
  double worst_translation_m = 0;        ///< over all judged
  double worst_rotation_rad = 0;
};

/// What a pose that is claimed is off by, by its motion since an earlier one.
struct JudgedPose {
  std::int64_t timestamp_ns = 0;
  double translation_m = 0;
  double rotation_rad = 0;
  bool silent = false;  ///< beyond the limits
};

/// The poses that silent_failures() judges, in order: all of the estimate for which the ground truth is
/// known, but the first of them.
[[nodiscard]] std::vector<JudgedPose> judged_poses(const Trajectory& ground_truth, const Trajectory& estimate,
                                                   const SilentFailureLimits& limits = {});

/// Judges each pose of the estimate by its motion since the latest pose that is at least `interval_s` older
/// (in the first interval: since the first pose), so that a frame after a gap is judged by the whole gap:
/// E = (G_i^-1 G_j)^-1 (P_i^-1 P_j) for estimate P and ground truth G, which is interpolated between stamps
/// less than 0.1 s apart. Nothing is aligned. Error data_corrupt: no pose could be judged.
[[nodiscard]] Result<SilentFailures> silent_failures(const Trajectory& ground_truth,
                                                     const Trajectory& estimate,
                                                     const SilentFailureLimits& limits = {});

}  // namespace fusebench::trajectory_error
