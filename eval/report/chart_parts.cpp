#include "eval/report/chart_parts.hpp"

#include <algorithm>
#include <utility>

namespace fusebench::report {

page::Chart chart_of(std::string title, std::string x_label, std::string left_label, std::string caption) {
  page::Chart chart;
  chart.title = std::move(title);
  chart.caption = std::move(caption);
  chart.x_label = std::move(x_label);
  chart.left_label = std::move(left_label);
  return chart;
}

void add(std::vector<page::Chart>& charts, page::Chart chart) {
  std::erase_if(chart.series, [](const page::ChartSeries& s) { return s.points.empty() && s.boxes.empty(); });
  if (!chart.series.empty()) charts.push_back(std::move(chart));
}

std::vector<Vector2d> strided(const std::vector<Vector2d>& points, std::size_t most) {
  const std::size_t step = points.size() / std::max<std::size_t>(most, 1) + 1;
  std::vector<Vector2d> result;
  for (std::size_t i = 0; i < points.size(); i += step) result.push_back(points[i]);
  if (!points.empty() && (points.size() - 1) % step != 0) result.push_back(points.back());
  return result;
}

const RunSeries* with_truth(std::span<const RunSeries> runs) {
  const auto found = std::ranges::find_if(runs, [](const RunSeries& run) { return !run.truth.empty(); });
  return found == runs.end() ? nullptr : &*found;
}

}  // namespace fusebench::report
