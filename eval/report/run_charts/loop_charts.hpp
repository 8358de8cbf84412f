// Loops of a run as charts: where they lie on its path, when they were found, and what they changed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::run_charts {

/// The path before and after loops from three sides, with a line from each place to the frame that was
/// compared with it; those that were refused on request. At most so many lines of a kind.
[[nodiscard]] std::vector<page::Chart> loop_view_charts(const RunSeries& run, std::size_t buckets);

/// Candidates and motion blur over time, the error of the poses before and after, and how far they moved.
/// Charts that would be empty are left out.
[[nodiscard]] std::vector<page::Chart> loop_time_charts(const RunSeries& run, std::size_t buckets);

}  // namespace fusebench::run_charts
