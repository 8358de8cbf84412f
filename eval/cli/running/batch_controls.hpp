// What every verb shares that plans a batch of runs and runs it.
#pragma once

#include <vector>

#include "core/base/error.hpp"
#include "eval/engine/engine_options.hpp"
#include "eval/engine/job_outcome.hpp"
#include "eval/engine/job_plan.hpp"
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

/// Side by side, runs share the machine unless somebody says how many threads each has.
void share_threads(const BatchControls& controls, engine::BatchOptions& batch);

/// Prints what would run, and which of it is finished.
void print_preview(const engine::BatchPlan& plan, const BatchControls& controls);

/// Simulates what is missing and runs the jobs on this machine. Errors: those of the simulator and of
/// run_locally().
[[nodiscard]] Result<std::vector<engine::BatchOutcome>> run_here(const std::vector<engine::BatchJob>& jobs,
                                                                 const BatchControls& controls,
                                                                 const suites::RunLimits& limits,
                                                                 int all_threads);

}  // namespace fusebench::cli::running
