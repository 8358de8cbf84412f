// Collects the revised poses of a system at the end of a run.
#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "core/systems/system.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_evaluation.hpp"
#include "eval/run/run_frames.hpp"

namespace fusebench::run {

/// The revised poses of the system; nullopt if it has none or the run ended early. A failure ends the
/// run and is stored in the progress. Errors: run_failed (a stop).
[[nodiscard]] Result<std::optional<Trajectory>> revised_poses(systems::System& system, RunProgress& progress,
                                                              const RunControl& control);

/// The input of the metrics: the revised poses with the mesh of the online output.
[[nodiscard]] RunOutput final_output(const Trajectory& revised, const RunOutput& online);

}  // namespace fusebench::run
