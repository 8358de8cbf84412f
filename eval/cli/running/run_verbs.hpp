// Verbs that make runs, maintain their folders and collect their results.
#pragma once

#include "eval/cli/console/verb.hpp"

namespace fusebench::cli::running {

[[nodiscard]] console::Verb add_run_verb(CLI::App& app);
[[nodiscard]] console::Verb add_bench_verb(CLI::App& app);
[[nodiscard]] console::Verb add_reproduce_verb(CLI::App& app);
[[nodiscard]] console::Verb add_slurm_task_verb(CLI::App& app);
[[nodiscard]] console::Verb add_rerun_verb(CLI::App& app);
[[nodiscard]] console::Verb add_gc_verb(CLI::App& app);
[[nodiscard]] console::Verb add_merge_verb(CLI::App& app);
[[nodiscard]] console::Verb add_import_verb(CLI::App& app);
[[nodiscard]] console::Verb add_best_verb(CLI::App& app);
[[nodiscard]] console::Verb add_collect_verb(CLI::App& app);

}  // namespace fusebench::cli::running
