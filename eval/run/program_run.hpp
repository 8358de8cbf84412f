// One run of an external program.
#pragma once

#include "core/base/error.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"

namespace fusebench::run {

/// Exports the recording, runs the program, and evaluates its output as an imported run; the
/// folder gets record.json, trajectory.tum, truth.tum, mesh.ply and log.txt. A
/// program that crashes, hangs or writes unusable output gives a record with status failed and the reason.
/// Errors: as execute_run().
[[nodiscard]] Result<record::RunRecord> execute_program_run(const PreparedRun& run,
                                                            const RunControl& control);

}  // namespace fusebench::run
