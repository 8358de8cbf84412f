#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>

#include "eval/report/run_charts/chart_parts.hpp"
#include "eval/report/run_charts/run_charts.hpp"

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

/// Times of the recording: the ground truth often begins earlier and ends later.
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

/// The two axes along which the poses of all runs extend most.
std::array<int, 2> widest_axes(std::span<const RunSeries> runs) {
  Eigen::AlignedBox3d box;
  for (const RunSeries& run : runs) {
    for (const ComparedPose& pose : run.poses) {
      if (pose.T_truth_truth) box.extend(pose.T_truth_truth->translation);
    }
  }
  int narrowest = 0;
  if (box.isEmpty() || box.sizes().minCoeff(&narrowest) < 0) return {0, 1};
  return {narrowest == 0 ? 1 : 0, narrowest == 2 ? 1 : 2};
}

/// The value of the last colour, in centimetres: the largest error of the runs, without those of a few runs
/// that are far off.
double largest_shown_cm(std::span<const RunSeries> runs) {
  std::vector<double> peaks;
  for (const RunSeries& run : runs) {
    double peak = 0;
    for (const ComparedPose& pose : run.poses) {
      if (pose.T_truth_truth) peak = std::max(peak, kCentimetres * pose.error_m);
    }
    peaks.push_back(peak);
  }
  if (const auto top = top_of_most(peaks)) return *top;
  return peaks.empty() ? 0 : *std::ranges::max_element(peaks);
}

page::Chart error_path_chart(std::span<const RunSeries> runs, const RunSeries& run, double top_cm,
                             std::size_t buckets) {
  const auto [across, along] = widest_axes(runs);
  page::Chart chart = view_chart(std::span(&run, 1), across, along, buckets);
  chart.title = fmt::format("{}-{} view by error: {}", kAxes[static_cast<std::size_t>(across)],
                            kAxes[static_cast<std::size_t>(along)], run.label);
  page::ChartSeries& path = chart.series.back();
  path.points.clear();
  const std::size_t step = run.poses.size() / std::max<std::size_t>(2 * buckets, 1) + 1;
  for (std::size_t i = 0; i < run.poses.size(); i += step) {
    const ComparedPose& pose = run.poses[i];
    if (!pose.T_truth_truth) continue;
    const Vector3d& p = pose.T_truth_camera.translation;
    path.points.emplace_back(p[across], p[along]);
    path.values.push_back(kCentimetres * pose.error_m);
  }
  chart.value_colours = {"position error [cm]", top_cm};
  return chart;
}

}  // namespace

std::vector<page::Chart> error_path_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  const double top_cm = largest_shown_cm(runs);
  std::vector<page::Chart> charts;
  if (!(top_cm > 0)) return charts;
  for (const RunSeries& run : runs) {
    page::Chart chart = error_path_chart(runs, run, top_cm, buckets);
    if (chart.series.back().points.size() > 1) add(charts, std::move(chart));
  }
  return charts;
}

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
