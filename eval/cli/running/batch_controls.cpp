#include "eval/cli/running/batch_controls.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/engine_console.hpp"
#include "eval/cli/console/shared_options.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/engine/local_engine.hpp"
#include "eval/suites/engine/plan_preview.hpp"

namespace fusebench::cli::running {

void add_batch_controls(CLI::App& verb, engine::BatchOptions& batch, BatchControls& controls) {
  verb.add_option("--simulated", batch.simulated,
                  "Folder of the recordings that are simulated; those that are there are used again")
      ->type_name("DIR")
      ->capture_default_str();
  verb.add_option("-j,--jobs", controls.engine.at_once,
                  "Runs at a time, each in a process of its own; --threads is then by default its share of "
                  "the machine")
      ->check(CLI::Range(1, run::kMostAtOnce))
      ->type_name("N")
      ->capture_default_str();
  verb.add_flag("--dry-run", controls.dry_run,
                "Prints the runs, which are finished, and how long the others will take; runs nothing");
  console::add_threads_option(verb, batch.threads);
}

void share_threads(const BatchControls& controls, engine::BatchOptions& batch) {
  if (!controls.threads_given) batch.threads = std::max(1, batch.threads / controls.engine.at_once);
}

void print_preview(const engine::BatchPlan& plan, const BatchControls& controls) {
  const engine::PlanPreview preview = engine::preview_of(plan);
  const int at_once = controls.engine.at_once;
  console::print_output(controls.json ? engine::to_json(preview, plan, at_once)
                                      : engine::to_text(preview, plan, at_once));
}

Result<std::vector<engine::BatchOutcome>> run_here(const std::vector<engine::BatchJob>& jobs,
                                                   const BatchControls& controls,
                                                   const suites::RunLimits& limits, int all_threads) {
  if (auto made = console::simulate_missing(jobs, all_threads); !made) return tl::unexpected(made.error());
  engine::EngineOptions engine = controls.engine;
  engine.limits = limits;
  console::EngineConsole console(jobs);
  return engine::run_locally(jobs, engine, console.control());
}

}  // namespace fusebench::cli::running
