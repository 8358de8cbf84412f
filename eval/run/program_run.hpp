// One run of an external program, as a row beside those of the systems of this program.
#pragma once

#include "core/base/error.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"

namespace fusebench::run {

/// Exports the recording, runs the program, and evaluates what it left as an imported run is evaluated; the
/// folder gets record.json, trajectory.tum, truth.tum, mesh.ply and log.txt. A
/// program that dies, hangs or leaves what cannot be used is a record with status failed and its reason.
/// Errors: as execute_run().
[[nodiscard]] Result<record::RunRecord> execute_program_run(const PreparedRun& run,
                                                            const RunControl& control);

}  // namespace fusebench::run
