#include <CLI/CLI.hpp>
#include <cstddef>
#include <filesystem>
#include <memory>

#include "eval/cli/console/stop_signals.hpp"
#include "eval/cli/running/entered_invocation.hpp"
#include "eval/cli/running/run_verbs.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/engine/slurm_task.hpp"

namespace fusebench::cli::running {

console::Verb add_slurm_task_verb(CLI::App& app) {
  struct TaskOptions {
    std::filesystem::path invocation;
    std::filesystem::path tasks;
    std::size_t task = 0;
    engine::EngineOptions engine;
  };
  auto options = std::make_shared<TaskOptions>();
  CLI::App* verb = app.add_subcommand(
      "slurm-task",
      "Runs one task of a Slurm array (internal: called by the script that --executor slurm submits)");
  verb->add_option("INVOCATION", options->invocation, "Kept by bench")->required();
  verb->add_option("TASKS", options->tasks, "The array's task file")->required();
  verb->add_option("TASK", options->task, "Number of the task")->required();
  verb->add_option("-j,--jobs", options->engine.at_once, "Runs at a time")
      ->check(CLI::Range(1, run::kMostAtOnce));
  return {.app = verb,
          .run = [options]() -> Result<int> {
            const auto invocation = enter_invocation(options->invocation);
            if (!invocation) return tl::unexpected(invocation.error());
            const auto suite = engine::suite_of(*invocation);
            if (!suite) return tl::unexpected(suite.error());
            const auto plan = engine::plan_batch(*suite, invocation->options);
            if (!plan) return tl::unexpected(plan.error());
            options->engine.limits = suite->limits;
            engine::EngineControl control;
            const console::StopScope stopping(console::OnStop::end_itself);
            control.stop = &console::stop_requested();
            const auto done =
                engine::run_slurm_task(plan->jobs, options->engine, options->tasks, options->task, control);
            if (!done) return tl::unexpected(done.error());
            return 0;
          },
          .forks = true};
}

}  // namespace fusebench::cli::running
