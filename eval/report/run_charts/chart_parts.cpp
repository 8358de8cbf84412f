#include "eval/report/run_charts/chart_parts.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace fusebench::run_charts {

namespace {

/// The next of 1, 1.2, 1.5, 2, ... times a power of ten.
double round_above(double value) {
  const double decade = std::pow(10.0, std::floor(std::log10(value)));
  for (const double digits : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0}) {
    if (digits * decade >= value * (1 - 1e-9)) return digits * decade;
  }
  return 10 * decade;
}

double peak_of(const page::ChartSeries& series) {
  double peak = 0;
  for (const Vector2d& point : series.points) peak = std::max(peak, point.y());
  for (const page::ChartBox& box : series.boxes) peak = std::max(peak, box.max);
  return peak;
}

/// "cm" of "error [cm]".
std::string unit_of(const std::string& label) {
  const std::size_t open = label.rfind('[');
  if (open == std::string::npos || !label.ends_with(']')) return "";
  return " " + label.substr(open + 1, label.size() - open - 2);
}

void say(page::Chart& chart, const std::string& sentence) {
  chart.caption += (chart.caption.empty() ? "" : " ") + sentence;
}

Eigen::AlignedBox2d box_of(const page::ChartSeries& series) {
  Eigen::AlignedBox2d box;
  for (const Vector2d& point : series.points) {
    if (point.allFinite()) box.extend(point);
  }
  return box;
}

}  // namespace

std::optional<double> top_of_most(std::vector<double> peaks) {
  constexpr double kFar = 5;
  std::erase_if(peaks, [](double peak) { return !(peak > 0) || !std::isfinite(peak); });
  if (peaks.size() < 2) return std::nullopt;
  std::ranges::sort(peaks);
  const double most = kFar * peaks[(peaks.size() - 1) / 2];
  if (peaks.back() <= most) return std::nullopt;
  return round_above(1.1 * *std::prev(std::ranges::upper_bound(peaks, most)));
}

void cut_far_values(page::Chart& chart) {
  std::vector<double> peaks;
  for (const page::ChartSeries& series : chart.series) {
    if (!series.right) peaks.push_back(peak_of(series));
  }
  const auto top = top_of_most(std::move(peaks));
  if (!top) return;
  const std::string unit = unit_of(chart.left_label);
  chart.y_range = {0, *top};
  std::string beyond;
  bool marked = false;  // a band that is cut has no triangles
  for (const page::ChartSeries& series : chart.series) {
    const double peak = peak_of(series);
    if (series.right || peak <= *top) continue;
    beyond += fmt::format("{}{} reaches {:.3g}{}", beyond.empty() ? "" : ", ", series.label, peak, unit);
    marked = marked || series.style != page::SeriesStyle::band;
  }
  say(chart,
      fmt::format("Cut at {:.3g}{}{}: {}.", *top, unit, marked ? ", where triangles stand" : "", beyond));
}

void cut_far_places(page::Chart& chart) {
  const auto truth = std::ranges::find(chart.series, page::SeriesStyle::backdrop, &page::ChartSeries::style);
  if (truth == chart.series.end() || truth->points.empty()) return;
  Eigen::AlignedBox2d shown = box_of(*truth);
  Eigen::AlignedBox2d allowed = shown;
  Vector2d around = shown.sizes();
  if (chart.equal_scale) around = Vector2d::Constant(around.maxCoeff());
  constexpr double kLeast_m = 0.1;  // a camera that hardly moves is no measure
  around = around.cwiseMax(kLeast_m);
  if (!chart.equal_scale) around.x() = std::numeric_limits<double>::infinity();  // all of the time
  allowed.min() -= around;
  allowed.max() += around;
  std::string beyond;
  for (const page::ChartSeries& series : chart.series) {
    if (series.on_request || series.points.empty()) continue;
    const Eigen::AlignedBox2d box = box_of(series);
    shown.extend(Eigen::AlignedBox2d(box.min().cwiseMax(allowed.min()), box.max().cwiseMin(allowed.max())));
    if (!allowed.contains(box)) beyond += (beyond.empty() ? "" : ", ") + series.label;
  }
  if (beyond.empty()) return;
  const Vector2d margin = 0.04 * shown.sizes();
  if (chart.equal_scale) chart.x_range = {shown.min().x() - margin.x(), shown.max().x() + margin.x()};
  chart.y_range = {shown.min().y() - margin.y(), shown.max().y() + margin.y()};
  say(chart, fmt::format("Cut around the ground truth; beyond it runs {}.", beyond));
}

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

}  // namespace fusebench::run_charts
