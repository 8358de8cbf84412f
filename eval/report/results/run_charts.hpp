// The charts of a recording: all of its runs in each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "eval/report/page.hpp"
#include "eval/report/results/run_series.hpp"

namespace fusebench {

/// buckets: of thinned(), for what changes with time. Charts that would be empty are left out.
[[nodiscard]] std::vector<Chart> view_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<Chart> position_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<Chart> error_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<Chart> motion_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<Chart> tracking_charts(std::span<const RunSeries> runs, std::size_t buckets);

}  // namespace fusebench
