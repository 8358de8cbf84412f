// The end of a run of a system that revises its poses.
#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/systems/system.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_frames.hpp"

namespace fusebench::run {

/// The revised poses of the system; nothing if it has none, or the run did not come to its end. What
/// goes wrong ends the run and is in the progress. Errors: run_failed (a stop).
[[nodiscard]] Result<std::optional<Trajectory>> revised_poses(systems::System& system, RunProgress& progress,
                                                              const RunControl& control);

/// What metrics need of the revised poses, with the mesh of the online output.
[[nodiscard]] RunOutput final_output(const Trajectory& revised, const RunOutput& online);

}  // namespace fusebench::run
