#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "eval/run_charts/chart_parts.hpp"
#include "eval/run_charts/run_charts.hpp"

namespace fusebench::run_charts {

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

template <class Value>
std::vector<Vector2d> of_poses(const RunSeries& run, const Value& value) {
  std::vector<Vector2d> points;
  for (const ComparedPose& pose : run.poses) points.push_back(value(pose));
  return points;
}

template <class Value>
std::vector<Vector2d> of_truth(const RunSeries& run, const Value& value) {
  std::vector<Vector2d> points;
  for (const StampedPose& pose : run.truth) points.push_back(value(pose));
  return points;
}

page::Chart view_chart(std::span<const RunSeries> runs, int across, int along, std::size_t buckets) {
  const auto name = [](int axis) { return kAxes[static_cast<std::size_t>(axis)]; };
  page::Chart chart = chart_of(fmt::format("{}-{} view", name(across), name(along)),
                               fmt::format("{} [m]", name(across)), fmt::format("{} [m]", name(along)));
  chart.from_zero = false;
  chart.equal_scale = true;
  const auto place = [&](const Vector3d& p) { return Vector2d(p[across], p[along]); };
  if (const RunSeries* run = with_truth(runs)) {
    chart.series.push_back(
        {"ground truth",
         strided(of_truth(*run, [&](const StampedPose& p) { return place(p.T_world_camera.translation); }),
                 2 * buckets),
         page::SeriesStyle::backdrop, false, 0});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto points =
        of_poses(runs[i], [&](const ComparedPose& p) { return place(p.T_truth_camera.translation); });
    chart.series.push_back(
        {runs[i].label, strided(points, 2 * buckets), page::SeriesStyle::line, false, runs[i].colour});
  }
  cut_far_places(chart);
  return chart;
}

/// Times of the recording: the truth often begins earlier and ends later.
Vector2d shown_times_s(std::span<const RunSeries> runs) {
  Vector2d range(0, 0);
  for (const RunSeries& run : runs) {
    if (!run.poses.empty()) range[1] = std::max(range[1], run.time_s(run.poses.back().timestamp_ns));
    if (!run.frames.empty()) range[1] = std::max(range[1], run.time_s(run.frames.back().timestamp_ns));
  }
  return range;
}

page::Chart position_chart(std::span<const RunSeries> runs, int axis, std::size_t buckets) {
  page::Chart chart = chart_of(fmt::format("Position along {}", kAxes[static_cast<std::size_t>(axis)]),
                               "time [s]", fmt::format("{} [m]", kAxes[static_cast<std::size_t>(axis)]));
  chart.from_zero = false;
  if (const RunSeries* run = with_truth(runs)) {
    auto points = of_truth(*run, [&](const StampedPose& p) {
      return Vector2d(run->time_s(p.timestamp_ns), p.T_world_camera.translation[axis]);
    });
    const Vector2d times_s = shown_times_s(runs);
    std::erase_if(points, [&](const Vector2d& p) { return p.x() < times_s[0] || p.x() > times_s[1]; });
    chart.series.push_back(
        {"ground truth", page::thinned(points, buckets), page::SeriesStyle::backdrop, false, 0});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto points = of_poses(runs[i], [&](const ComparedPose& p) {
      return Vector2d(runs[i].time_s(p.timestamp_ns), p.T_truth_camera.translation[axis]);
    });
    chart.series.push_back(
        {runs[i].label, page::thinned(points, buckets), page::SeriesStyle::line, false, runs[i].colour});
  }
  cut_far_places(chart);
  return chart;
}

}  // namespace

std::vector<page::Chart> view_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<page::Chart> charts;
  add(charts, view_chart(runs, 0, 1, buckets));
  add(charts, view_chart(runs, 0, 2, buckets));
  add(charts, view_chart(runs, 1, 2, buckets));
  return charts;
}

std::vector<page::Chart> position_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<page::Chart> charts;
  for (const int axis : {0, 1, 2}) add(charts, position_chart(runs, axis, buckets));
  return charts;
}

}  // namespace fusebench::run_charts
