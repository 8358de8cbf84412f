// What the runs of a suite say together: counts, summary, bars and exit code.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/running/suite_run.hpp"
#include "eval/engine/job_outcome.hpp"
#include "eval/engine/job_plan.hpp"
#include "eval/study/bar_check.hpp"
#include "eval/suites/experiment.hpp"

namespace fusebench::cli::running {

struct RunCounts {
  std::size_t ok = 0;
  std::size_t failed = 0;
  std::size_t total = 0;
};

[[nodiscard]] RunCounts counts_of(const std::vector<engine::BatchOutcome>& outcomes);

/// What the runs say together: the files that were asked for, the tables, and the bars. Nothing of that is
/// for a suite without bars unless a file is asked for.
[[nodiscard]] Result<std::vector<study::BarResult>> conclude(
    const suites::Suite& suite, const BenchOptions& options, const engine::BatchPlan& plan,
    const std::vector<engine::BatchOutcome>& outcomes);

/// Bars say what a lost run means; without bars, each run has to be ok.
[[nodiscard]] int exit_code_of(const RunCounts& counts, const std::vector<study::BarResult>& bars);

[[nodiscard]] std::string json_of(const suites::Suite& suite, const engine::BatchPlan& plan,
                                  const std::vector<engine::BatchOutcome>& outcomes, const RunCounts& counts,
                                  const std::vector<study::BarResult>& bars);

}  // namespace fusebench::cli::running
