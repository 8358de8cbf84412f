// Where the colour camera of a recording truly was.
#pragma once

#include <cstdint>
#include <optional>

#include "core/trajectory/trajectory.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::record {

/// T_truth_camera at an instant; nothing where the ground truth does not reach.
[[nodiscard]] inline std::optional<SE3> true_camera(const recording::Recording& recording,
                                                    std::int64_t instant_ns) {
  return trajectory::interpolate_pose(recording.ground_truth, instant_ns, trajectory::kMaxTruthGap_ns);
}

}  // namespace fusebench::record
