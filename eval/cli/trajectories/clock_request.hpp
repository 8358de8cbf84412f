// --fit-time-offset of `fusebench eval ate` and `rpe`.
#pragma once

#include <optional>

#include "core/base/error.hpp"
#include "eval/cli/trajectories/loaded_sides.hpp"
#include "eval/metrics/reference_clock/clocked_errors.hpp"
#include "eval/metrics/trajectory_error/trajectory_evaluation.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::trajectories {

void add_clock_option(CLI::App& verb, bool& fit_time_offset, const char* what_it_does);

/// Fits the offset of the reference's clock, after the request's own offset of stamps and within its time
/// range, and adds the errors with it to the evaluation, as series whose names end with "_clock_fitted".
/// Errors: usage for trajectories without stamps; those of fitted_time_offset() and evaluate().
[[nodiscard]] Result<reference_clock::ReferenceClock> fit_clock(
    const Sides& sides, const trajectory_error::TrajectoryRequest& request,
    trajectory_error::TrajectoryEvaluation& evaluation);

}  // namespace fusebench::cli::trajectories
