// The charts of a recording: all of its runs in each.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::run_charts {

/// buckets: of thinned(), for what changes with time. Charts that would be empty are left out.
[[nodiscard]] std::vector<page::Chart> view_charts(std::span<const RunSeries> runs, std::size_t buckets);
/// A chart a run: its path in the plane of its largest extents, each piece coloured by the position error.
/// All have one range of colours. Without a ground truth there are none.
[[nodiscard]] std::vector<page::Chart> error_path_charts(std::span<const RunSeries> runs,
                                                         std::size_t buckets);
[[nodiscard]] std::vector<page::Chart> position_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<page::Chart> error_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<page::Chart> motion_charts(std::span<const RunSeries> runs, std::size_t buckets);
[[nodiscard]] std::vector<page::Chart> tracking_charts(std::span<const RunSeries> runs, std::size_t buckets);

}  // namespace fusebench::run_charts
