// Loops of a run against the ground truth.
#pragma once

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/loops/loop_closure.hpp"
#include "eval/metrics/loop_error/loop_metrics.hpp"

namespace fusebench::loop_error {

/// truth: of the camera, at the stamps of the frames; places in its gaps are left out. Errors: those of
/// LoopClosure::poses_with().
[[nodiscard]] Result<LoopError> loop_error(const loops::LoopClosure& closure, const Trajectory& truth,
                                           const PinholeCamera& camera, const config::DepthConfig& depth,
                                           const config::LoopsConfig& loops);

}  // namespace fusebench::loop_error
