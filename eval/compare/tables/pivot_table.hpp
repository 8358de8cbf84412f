// One number of a folder of runs: recordings by methods.
#pragma once

#include <cstddef>
#include <string>

#include "core/base/error.hpp"
#include "eval/compare/tables/table.hpp"

namespace fusebench::tables {

/// A line a recording (a window of it, and data of one kind), a column a method; the smallest shown number of
/// a line is bold in LaTeX, if there are others. An error of a run that tracked less than kLeastCoverage of
/// the share of frames of another run has its share, "1.68 (20 %)", and is not bold; that of a run whose
/// poses contradict the ground truth has a "*". Medians with ranges over replicates; "lost" or "failed" of
/// runs that are not ok, empty where a method was not run. Of repetitions the first. format: markdown, csv
/// (numbers in SI, a line a recording) or latex. Error usage: another format.
[[nodiscard]] Result<std::string> render_pivot(const ResultTable& table, const registry::RunMetric& metric,
                                               TableFormat format, const LatexLayout& layout = {},
                                               std::size_t width = 0);

}  // namespace fusebench::tables
