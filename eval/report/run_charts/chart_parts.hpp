// What the charts of runs are made of.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/page/page.hpp"
#include "eval/report/run_charts/run_series.hpp"

namespace fusebench::run_charts {

inline constexpr double kCentimetres = 100;

[[nodiscard]] page::Chart chart_of(std::string title, std::string x_label, std::string left_label,
                                   std::string caption = "");

/// Without series that are empty; not if all are.
void add(std::vector<page::Chart>& charts, page::Chart chart);

/// Every so many of the points, the last among them: for curves that may run in any direction.
[[nodiscard]] std::vector<Vector2d> strided(const std::vector<Vector2d>& points, std::size_t most);

/// Where an axis of values ends so that a few that are far beyond do not flatten the others: somewhat above
/// the largest of the peaks that are not over five times their median. Nothing if there are none beyond.
[[nodiscard]] std::optional<double> top_of_most(std::vector<double> peaks);

/// Cuts the axis of values there, by the peaks of the chart's series, and says in the caption which are
/// beyond.
void cut_far_values(page::Chart& chart);

/// The same for views from above and the side, and for positions over time: around the series of the ground
/// truth, with what runs within three times its extent.
void cut_far_places(page::Chart& chart);

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

}  // namespace fusebench::run_charts
