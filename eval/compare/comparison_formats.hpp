// A comparison for people, for pull requests and for the programs that watch numbers.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/comparison.hpp"

namespace fusebench::compare {

enum class ComparisonFormat {
  table,             ///< for terminals
  markdown,          ///< for a pull request
  json,              ///< everything
  junit,             ///< a test case a gate, for the test views of CI services
  gbench,            ///< times of NEW as Google Benchmark writes them
  github_benchmark,  ///< numbers of NEW as customSmallerIsBetter of github-action-benchmark
  openmetrics,       ///< numbers of NEW as OpenMetrics text
};
/// Error usage.
[[nodiscard]] Result<ComparisonFormat> parse_comparison_format(std::string_view text);

/// all: also gates that are unchanged (of table and markdown; the others have what they have). width: of a
/// line of table, 0: any.
[[nodiscard]] std::string render_comparison(const RunComparison& comparison, ComparisonFormat format,
                                            bool all = false, std::size_t width = 0);

/// One gate as people read it.
struct ComparisonLine {
  GateVerdict verdict = GateVerdict::unchanged;
  std::string run;
  std::string gate;
  std::string message;
};
/// Regressions, changes, improvements, possible slowdowns, notes; with `all` what is unchanged, too.
/// Divergences and times that are not gated stand in comparison_remarks() unless `all`.
[[nodiscard]] std::vector<ComparisonLine> comparison_lines(const RunComparison& comparison, bool all);

/// "FAIL: 1 regression, 3 changed, 2 improvements, 0 possible slowdowns in 24 runs; trajectories: 22
/// bit-identical, 2 different".
[[nodiscard]] std::string comparison_summary(const RunComparison& comparison);

/// Sentences beneath the lines: where runs diverge, the earliest first; times that were not gated; notes.
[[nodiscard]] std::vector<std::string> comparison_remarks(const RunComparison& comparison);

[[nodiscard]] std::string comparison_text(const RunComparison& comparison, bool all, std::size_t width = 0);
[[nodiscard]] std::string comparison_markdown(const RunComparison& comparison, bool all);
[[nodiscard]] std::string comparison_json(const RunComparison& comparison);
[[nodiscard]] std::string comparison_junit(const RunComparison& comparison);
[[nodiscard]] std::string comparison_gbench(const RunComparison& comparison);
[[nodiscard]] std::string comparison_github_benchmark(const RunComparison& comparison);
[[nodiscard]] std::string comparison_openmetrics(const RunComparison& comparison);

}  // namespace fusebench::compare
