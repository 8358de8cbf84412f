// One specification in, one record and one folder out. The only place that knows recordings, estimator and
// metrics.
#pragma once

#include "core/base/error.hpp"
#include "eval/record/record.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"
#include "eval/run/run_specification.hpp"

namespace fusebench::run {

/// Runs it and puts its folder in place. A run that is lost or fails on the way is a record with that status
/// and its reason, and its folder holds what there is. Errors: io if the folder cannot be written, run_failed
/// if it was stopped, data_missing and data_corrupt if bad data is not recorded; nothing is left behind then.
[[nodiscard]] Result<record::RunRecord> execute_run(const PreparedRun& run, const RunControl& control = {});

}  // namespace fusebench::run
