// The runs of a plan on this machine: each in a process of its own, several at a time, none twice.
#pragma once

#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/engine/engine_options.hpp"
#include "eval/suites/engine/job_outcome.hpp"
#include "eval/suites/engine/job_plan.hpp"

namespace fusebench::engine {

/// Runs the jobs and gives their outcomes in the order of the jobs. A finished run (ok or lost) of the same
/// identity is left as it is; a failed one is tried again. A run that fails, crashes, hangs or needs too much
/// memory is an outcome with its reason, and the others go on. Fewer than `at_once` run while the machine's
/// memory would not hold one more. What is being run by another engine on the same folder is waited for.
///
/// No other thread of this process may be at work: processes are forked from it. Errors: io (results cannot
/// be written: nothing more is started, finished runs stay, and the same call goes on later), run_failed
/// (stopped: runs that were not finished leave nothing).
[[nodiscard]] Result<std::vector<BatchOutcome>> run_locally(std::span<const BatchJob> jobs,
                                                            const EngineOptions& options,
                                                            const EngineControl& control = {});

}  // namespace fusebench::engine
