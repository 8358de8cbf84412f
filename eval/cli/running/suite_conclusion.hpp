// The result of a suite as a whole: counts, summary, acceptance criteria and exit code.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/running/suite_run.hpp"
#include "eval/compare/study/criteria_check.hpp"
#include "eval/suites/engine/job_outcome.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/suite_file.hpp"

namespace fusebench::cli::running {

struct RunCounts {
  std::size_t ok = 0;
  std::size_t failed = 0;
  std::size_t total = 0;
};

[[nodiscard]] RunCounts counts_of(const std::vector<engine::BatchOutcome>& outcomes);

/// Summarises the runs: requested files, tables and criteria. Does nothing for a suite without criteria if no
/// file is requested.
[[nodiscard]] Result<std::vector<study::CriterionResult>> conclude(
    const suites::Suite& suite, const BenchOptions& options, const engine::BatchPlan& plan,
    const std::vector<engine::BatchOutcome>& outcomes);

/// 1 if a criterion failed. With criteria, lost runs count by them; without criteria, every run must be ok.
[[nodiscard]] int exit_code_of(const RunCounts& counts, const std::vector<study::CriterionResult>& criteria);

[[nodiscard]] std::string json_of(const suites::Suite& suite, const engine::BatchPlan& plan,
                                  const std::vector<engine::BatchOutcome>& outcomes, const RunCounts& counts,
                                  const std::vector<study::CriterionResult>& criteria);

}  // namespace fusebench::cli::running
