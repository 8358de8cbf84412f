// What the charts of runs are made of.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_series.hpp"

namespace fusebench::report {

inline constexpr double kCentimetres = 100;

[[nodiscard]] page::Chart chart_of(std::string title, std::string x_label, std::string left_label,
                                   std::string caption = "");

/// Without series that are empty; not if all are.
void add(std::vector<page::Chart>& charts, page::Chart chart);

/// Every so many of the points, the last among them: for curves that may run in any direction.
[[nodiscard]] std::vector<Vector2d> strided(const std::vector<Vector2d>& points, std::size_t most);

/// The runs' colours come after that of the truth, also where the truth is not drawn.
[[nodiscard]] inline std::size_t colour_of(std::size_t run) { return run + 1; }

/// The first run that has a ground truth; null if there is none.
[[nodiscard]] const RunSeries* with_truth(std::span<const RunSeries> runs);

/// A number of each frame over time, where it is finite.
template <class Value>
std::vector<Vector2d> of_frames(const RunSeries& run, std::size_t buckets, const Value& value) {
  std::vector<Vector2d> points;
  for (const run_files::FrameTableRow& frame : run.frames) {
    const double y = value(frame);
    if (std::isfinite(y)) points.emplace_back(run.time_s(frame.timestamp_ns), y);
  }
  return page::thinned(points, buckets);
}

}  // namespace fusebench::report
