// The verbs of the command line. Each adds its options to the application and returns what to do when it was
// chosen: an exit code, or an error that main() prints.
#pragma once

#include <functional>

#include "core/error.hpp"

namespace CLI {
class App;
}

namespace fusebench {

struct Verb {
  CLI::App* app = nullptr;
  std::function<Result<int>()> run;
};

[[nodiscard]] Verb add_run_verb(CLI::App& app);
[[nodiscard]] Verb add_bench_verb(CLI::App& app);
[[nodiscard]] Verb add_sweep_verb(CLI::App& app);
[[nodiscard]] Verb add_slurm_task_verb(CLI::App& app);
[[nodiscard]] Verb add_rerun_verb(CLI::App& app);
[[nodiscard]] Verb add_gc_verb(CLI::App& app);
[[nodiscard]] Verb add_merge_verb(CLI::App& app);
[[nodiscard]] Verb add_best_verb(CLI::App& app);
[[nodiscard]] Verb add_collect_verb(CLI::App& app);
[[nodiscard]] Verb add_compare_verb(CLI::App& app);
[[nodiscard]] Verb add_table_verb(CLI::App& app);
[[nodiscard]] Verb add_report_verb(CLI::App& app);
[[nodiscard]] Verb add_import_verb(CLI::App& app);
[[nodiscard]] Verb add_eval_verb(CLI::App& app);
[[nodiscard]] Verb add_list_verb(CLI::App& app);
[[nodiscard]] Verb add_config_verb(CLI::App& app);
[[nodiscard]] Verb add_simulate_verb(CLI::App& app);
[[nodiscard]] Verb add_inspect_verb(CLI::App& app);
[[nodiscard]] Verb add_calibrate_verb(CLI::App& app);
[[nodiscard]] Verb add_smooth_verb(CLI::App& app);

}  // namespace fusebench
