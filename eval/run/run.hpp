// Executes one run: from its specification to its record and folder. The only unit that uses recordings,
// estimator and metrics.
#pragma once

#include "core/base/error.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"
#include "eval/run/run_specification.hpp"

namespace fusebench::run {

/// Executes the run and commits its folder. A run that is lost or fails gives a record with that status and
/// the reason, and a folder with the files so far. Errors: io if the folder cannot be written, run_failed
/// if it was stopped, data_missing and data_corrupt if bad data is not recorded; no files remain then.
[[nodiscard]] Result<record::RunRecord> execute_run(const PreparedRun& run, const RunControl& control = {});

}  // namespace fusebench::run
