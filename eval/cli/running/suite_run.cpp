#include "eval/cli/running/suite_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>
#include <vector>

#include "eval/cli/console/console.hpp"
#include "eval/cli/console/engine_console.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/running/suite_conclusion.hpp"
#include "eval/suites/engine/simulated_recordings.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::cli::running {

namespace {

Result<std::vector<engine::BatchOutcome>> run_on_cluster(const BenchOptions& options,
                                                         const suites::Suite& suite,
                                                         const engine::BatchPlan& plan, int all_threads,
                                                         const std::filesystem::path& kept) {
  if (auto made = console::simulate_missing(plan.jobs, all_threads); !made)
    return tl::unexpected(made.error());
  engine::EngineOptions engine = options.controls.engine;
  engine.limits = suite.limits;
  console::EngineConsole console(plan.jobs);
  std::error_code ignored;
  const engine::SlurmSite site{std::filesystem::absolute(kept, ignored),
                               std::filesystem::read_symlink("/proc/self/exe", ignored)};
  return engine::run_on_slurm(plan.jobs, engine, options.slurm, site, console.control());
}

Result<std::vector<engine::BatchOutcome>> run_plan(const BenchOptions& options, const suites::Suite& suite,
                                                   const engine::BatchPlan& plan, int all_threads) {
  if (options.executor == "slurm") {
    if (auto usable = engine::check_slurm(options.slurm); !usable) return tl::unexpected(usable.error());
  }
  const auto kept = engine::keep(options.invocation);
  if (!kept) return tl::unexpected(kept.error());
  if (options.executor == "slurm") return run_on_cluster(options, suite, plan, all_threads, *kept);
  return run_here(plan.jobs, options.controls, suite.limits, all_threads);
}

/// Sets threads and runs at a time: on a cluster one thread per run without --threads.
Result<void> set_executor(BenchOptions& options) {
  if (options.executor == "local") {
    if (options.slurm.submit_only || options.slurm.chunk > 0 || !options.slurm.arguments.empty())
      return fail(ErrorCode::usage, "--submit, --chunk and --slurm-arg require --executor slurm");
    share_threads(options.controls, options.invocation.options);
    return {};
  }
  int& threads = options.invocation.options.threads;
  const int at_once = options.controls.engine.at_once;
  if (!options.controls.threads_given) threads = 1;
  options.slurm.at_once = at_once;
  options.slurm.cpus = at_once * threads;
  if (!options.controls.engine.repeat_finished) return {};
  return fail(ErrorCode::usage, "--repeat requires --executor local",
              "pass another --out to repeat all runs");
}

/// Returns when everything is in the queue.
Result<int> submit(const BenchOptions& options, const suites::Suite& suite, const engine::BatchPlan& plan,
                   int all_threads) {
  const auto outcomes = run_plan(options, suite, plan, all_threads);
  if (!outcomes) return tl::unexpected(outcomes.error());
  const std::string out = options.invocation.options.out.string();
  console::print_progress(
      fmt::format("{}: submitted; `fusebench collect {}` shows finished runs, and the same command without "
                  "--submit waits for the others and resubmits lost runs",
                  suite.name, out));
  return 0;
}

}  // namespace

Result<int> run_suite(BenchOptions options) {
  const auto suite = engine::suite_of(options.invocation);
  if (!suite) return tl::unexpected(suite.error());
  engine::BatchOptions& batch = options.invocation.options;
  if (batch.out.empty()) batch.out = std::filesystem::path("results/runs") / suite->name;
  const int all_threads = batch.threads;
  if (auto sensible = set_executor(options); !sensible) return tl::unexpected(sensible.error());
  const auto plan = engine::plan_batch(*suite, batch);
  if (!plan) return tl::unexpected(plan.error());
  if (auto sensible = engine::check_simulations(plan->jobs); !sensible)
    return tl::unexpected(sensible.error());
  console::print_warnings(plan->warnings);
  for (const std::string& absent : plan->absent) console::print_progress("warning: left out: " + absent);
  if (options.controls.dry_run) {
    print_preview(*plan, options.controls);
    return 0;
  }
  if (plan->jobs.empty()) {
    return fail(ErrorCode::usage,
                fmt::format("all {} runs of suite '{}' are excluded, the first one because: {}",
                            plan->excluded.size(), suite->name, plan->excluded.front().reason),
                "[[exclude]] without recording, variant and options leaves everything out");
  }
  if (options.executor == "slurm" && options.slurm.submit_only)
    return submit(options, *suite, *plan, all_threads);
  const auto outcomes = run_plan(options, *suite, *plan, all_threads);
  if (!outcomes) return tl::unexpected(outcomes.error());

  const RunCounts counts = counts_of(*outcomes);
  if (options.controls.engine.only_failed) {
    console::print_progress(
        fmt::format("{}: {} runs were run again, {} of them ok", suite->name, counts.total, counts.ok));
    return counts.failed == 0 ? 0 : console::kExitRunFailed;
  }
  if (counts.total == 0) {
    return fail(ErrorCode::data_missing,
                fmt::format("suite '{}': none of the recordings can be opened", suite->name),
                "the lines above give the reasons");
  }
  console::print_progress(fmt::format(
      "{}: {} of {} runs ok{}; `fusebench table {}` shows them", suite->name, counts.ok, counts.total,
      plan->excluded.empty() ? "" : fmt::format(", {} excluded", plan->excluded.size()), batch.out.string()));
  const console::Progress progress("summary of the runs");
  const console::Heartbeat heartbeat;
  const auto criteria = conclude(*suite, options, *plan, *outcomes);
  if (!criteria) return tl::unexpected(criteria.error());
  if (options.controls.json) console::print_output(json_of(*suite, *plan, *outcomes, counts, *criteria));
  return exit_code_of(counts, *criteria);
}

}  // namespace fusebench::cli::running
