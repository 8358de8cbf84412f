// The part of a recording's results that is about loops and what they made of the poses.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::report {

/// Whether the run kept places to find again, or revised its poses at the end.
[[nodiscard]] inline bool has_loops(const run_charts::RunSeries& run) {
  return !run.places.empty() || !run.final_poses.empty();
}

/// A table of all of these runs that have loops, and charts of the first few of them. None without such runs.
[[nodiscard]] std::vector<page::PageSection> loop_sections(std::span<const run_charts::RunSeries> runs,
                                                           std::size_t buckets);

}  // namespace fusebench::report
