// How the stages of profiled runs are spread over their frames.
#pragma once

#include <span>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::run_charts {

/// One chart a profiled run, with what it shows as its caption; none of the others.
[[nodiscard]] std::vector<page::Chart> profile_charts(std::span<const RunSeries> runs);

}  // namespace fusebench::run_charts
