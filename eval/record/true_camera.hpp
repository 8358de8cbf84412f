// Where the colour camera of a recording truly was.
#pragma once

#include <cstdint>
#include <optional>

#include "core/trajectory/trajectory.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::record {

/// Ground truth further apart than this is not interpolated.
inline constexpr std::int64_t kMaxTruthGap_ns = 100'000'000;

/// T_truth_camera at an instant; nothing where the ground truth does not reach.
[[nodiscard]] inline std::optional<SE3> true_camera(const recording::Recording& recording,
                                                    std::int64_t instant_ns) {
  return trajectory::interpolate_pose(recording.ground_truth, instant_ns, kMaxTruthGap_ns);
}

}  // namespace fusebench::record
