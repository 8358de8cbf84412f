// Options and steps of the verbs that plan and run a batch of runs.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/engine/engine_options.hpp"
#include "eval/suites/engine/job_outcome.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/run_selection.hpp"

namespace CLI {
class App;
}

namespace fusebench::cli::running {

struct BatchControls {
  engine::EngineOptions engine;
  bool dry_run = false;
  bool threads_given = false;
  bool json = false;
};

/// --simulated, -j, --dry-run and --threads.
void add_batch_controls(CLI::App& verb, engine::BatchOptions& batch, BatchControls& controls);

/// Without --threads, parallel runs share the threads of the machine.
void share_threads(const BatchControls& controls, engine::BatchOptions& batch);

/// Prints the planned runs and which of them are finished.
void print_preview(const engine::BatchPlan& plan, const BatchControls& controls);

/// Simulates missing recordings and runs the jobs on this machine. Errors: those of the simulator and of
/// run_locally().
[[nodiscard]] Result<std::vector<engine::BatchOutcome>> run_here(const std::vector<engine::BatchJob>& jobs,
                                                                 const BatchControls& controls,
                                                                 const suites::RunLimits& limits,
                                                                 int all_threads);

}  // namespace fusebench::cli::running
