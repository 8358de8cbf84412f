// A suite from its file to its exit code.
#pragma once

#include <filesystem>
#include <string>

#include "core/base/error.hpp"
#include "eval/cli/running/batch_controls.hpp"
#include "eval/suites/engine/invocation.hpp"
#include "eval/suites/engine/slurm_engine.hpp"

namespace fusebench::cli::running {

struct BenchOptions {
  engine::Invocation invocation;
  BatchControls controls;
  std::string executor = "local";
  engine::SlurmOptions slurm;
  std::filesystem::path summary;
  std::filesystem::path summary_page;
};

/// Plans and runs the suite, prints its results and returns the exit code. Errors: those of suite_of(),
/// plan_batch() and the engines; usage for options that do not go together or a suite without runs;
/// data_missing if no recording can be opened.
[[nodiscard]] Result<int> run_suite(BenchOptions options);

}  // namespace fusebench::cli::running
