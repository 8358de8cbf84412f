#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "eval/metrics/mesh_error/mesh_metrics.hpp"
#include "eval/metrics/trajectory_error/motion_pairs.hpp"
#include "eval/metrics/trajectory_error/segment_errors.hpp"
#include "eval/report/run_charts/chart_parts.hpp"
#include "eval/report/run_charts/run_charts.hpp"

namespace fusebench::run_charts {

namespace {

std::vector<double> errors_cm(const RunSeries& run) {
  std::vector<double> errors;
  for (const ComparedPose& pose : run.poses) {
    if (pose.T_truth_truth) errors.push_back(kCentimetres * pose.error_m);
  }
  std::ranges::sort(errors);
  return errors;
}

page::Chart error_over_time(std::span<const RunSeries> runs, std::size_t buckets) {
  page::Chart chart =
      chart_of("Position error", "time [s]", "error [cm]", "After the alignment of the ATE (SE3).");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::vector<Vector2d> points;
    for (const ComparedPose& pose : runs[i].poses) {
      if (pose.T_truth_truth)
        points.emplace_back(runs[i].time_s(pose.timestamp_ns), kCentimetres * pose.error_m);
    }
    chart.series.push_back(
        {runs[i].label, page::thinned(points, buckets), page::SeriesStyle::line, false, runs[i].colour});
  }
  cut_far_values(chart);
  return chart;
}

page::Chart error_histogram(std::span<const RunSeries> runs) {
  constexpr std::size_t kBins = 30;
  page::Chart chart = chart_of("Histogram of position errors", "error [cm]", "share of frames [%]");
  std::vector<double> large_cm;
  for (const RunSeries& run : runs) {
    const auto errors = errors_cm(run);
    if (!errors.empty()) large_cm.push_back(mesh_error::percentile(errors, 0.98));
  }
  if (large_cm.empty() || std::ranges::max(large_cm) <= 0) return chart;
  const double largest_cm = top_of_most(large_cm).value_or(std::ranges::max(large_cm));
  chart.caption = fmt::format("{} bins; the last one holds everything beyond.", kBins);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto errors = errors_cm(runs[i]);
    if (errors.empty()) continue;
    std::array<double, kBins> counts{};
    for (const double error_cm : errors) {
      const auto bin = static_cast<std::size_t>(static_cast<double>(kBins) * error_cm / largest_cm);
      ++counts[std::min(bin, kBins - 1)];
    }
    page::ChartSeries series{runs[i].label, {}, page::SeriesStyle::bars, false, runs[i].colour};
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      series.points.emplace_back((static_cast<double>(bin) + 0.5) * largest_cm / static_cast<double>(kBins),
                                 100 * counts[bin] / static_cast<double>(errors.size()));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

page::Chart cumulative_errors(std::span<const RunSeries> runs, std::size_t buckets) {
  page::Chart chart = chart_of(
      "Cumulative position error", "error [cm]", "share of all frames [%]",
      "Share of the recording's frames whose error is smaller. A curve that ends below 100 % has lost "
      "frames.");
  std::vector<double> peaks_cm;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto errors = errors_cm(runs[i]);
    std::vector<Vector2d> points;
    const double all = static_cast<double>(std::max<std::size_t>(runs[i].run->record.frames.total, 1));
    for (std::size_t k = 0; k < errors.size(); ++k)
      points.emplace_back(errors[k], 100 * static_cast<double>(k + 1) / all);
    chart.series.push_back(
        {runs[i].label, strided(points, buckets), page::SeriesStyle::line, false, runs[i].colour});
    if (!errors.empty()) peaks_cm.push_back(errors.back());
  }
  if (const auto top_cm = top_of_most(peaks_cm)) {
    chart.x_range = {0, *top_cm};
    chart.caption += fmt::format(" Cut at {:.3g} cm: some runs have larger errors.", *top_cm);
  }
  return chart;
}

/// By the first pose in place of an alignment: the filter's certainty counts from there.
page::Chart error_and_sigma(std::span<const RunSeries> runs, std::size_t buckets) {
  page::Chart chart = chart_of(
      "Drift against the filter's own 3 sigma", "time [s]", "distance [cm]",
      "Position relative to the first frame, without alignment. Bands: 3 sigma of the longest axis, as "
      "the filter estimates it; where a curve is above its band, the filter is overconfident.");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto first = std::ranges::find_if(
        runs[i].poses, [](const ComparedPose& p) { return p.T_truth_truth.has_value(); });
    if (first == runs[i].poses.end()) continue;
    std::vector<Vector2d> drift;
    const SE3 T_start_truth = first->T_truth_truth->inverse();
    const SE3 T_start_estimate = first->T_truth_camera.inverse();
    for (const ComparedPose& pose : runs[i].poses) {
      if (!pose.T_truth_truth) continue;
      const Vector3d truth = T_start_truth * pose.T_truth_truth->translation;
      const Vector3d estimate = T_start_estimate * pose.T_truth_camera.translation;
      drift.emplace_back(runs[i].time_s(pose.timestamp_ns), kCentimetres * (truth - estimate).norm());
    }
    chart.series.push_back(
        {runs[i].label, page::thinned(drift, buckets), page::SeriesStyle::line, false, runs[i].colour});
    chart.series.push_back({runs[i].label + ", 3 sigma",
                            of_frames(runs[i], buckets / 8 + 1,
                                      [](const run_files::FrameTableRow& f) {
                                        return f.is_in_map() ? 3 * kCentimetres * f.position_sigma_m
                                                             : std::nan("");
                                      }),
                            page::SeriesStyle::band, false, runs[i].colour});
  }
  cut_far_values(chart);
  return chart;
}

/// Logarithmic, since an overconfident filter is off by orders of magnitude.
page::Chart consistency_chart(std::span<const RunSeries> runs, std::size_t buckets, std::string_view part) {
  page::Chart chart = chart_of(
      fmt::format("Consistency of the {}", part), "time [s]", "log10 (NEES / 3)",
      "A consistent covariance has a mean NEES / 3 of 1, the 0 here; much above, it is overconfident.");
  chart.from_zero = false;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::vector<Vector2d> points;
    for (const run_files::NeesTableRow& row : runs[i].nees) {
      if (row.part == part && row.nees_per_dof > 0)
        points.emplace_back(runs[i].time_s(row.capture_ns), std::log10(row.nees_per_dof));
    }
    chart.series.push_back(
        {runs[i].label, page::thinned(points, buckets), page::SeriesStyle::line, false, runs[i].colour});
  }
  return chart;
}

trajectory_files::TrajectoryPair pair_of(const RunSeries& run) {
  trajectory_files::TrajectoryPair pair;
  for (const ComparedPose& pose : run.poses) {
    if (!pose.T_truth_truth) continue;
    pair.reference.push_back({pose.timestamp_ns, *pose.T_truth_truth});
    pair.estimate.push_back({pose.timestamp_ns, pose.T_truth_camera});
  }
  return pair;
}

page::Chart segment_boxes(std::span<const RunSeries> runs) {
  page::Chart chart = chart_of(
      "Relative error over segments of the path", "length of the segment [m]",
      "translation error [% of the length]",
      "Boxes from the lower to the upper quartile with the median; whiskers to the extremes. Lengths are "
      "10 to 50 % of the true path (rpg_trajectory_evaluation).");
  const RunSeries* const known = with_truth(runs);
  const std::vector<double> lengths =
      known != nullptr ? trajectory_error::rpg_lengths(known->truth) : std::vector<double>();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const trajectory_files::TrajectoryPair pair = pair_of(runs[i]);
    if (pair.size() < 2) continue;
    page::ChartSeries series{runs[i].label, {}, page::SeriesStyle::boxes, false, runs[i].colour};
    for (const double length_m : lengths) {
      if (!(length_m > 0)) continue;
      const trajectory_error::IndexPairs segments =
          trajectory_error::rpg_motions(pair.reference, length_m, /*as_published=*/false);
      if (segments.empty()) continue;
      std::vector<double> errors = trajectory_error::segment_errors(pair, segments, length_m).translation_m;
      for (double& error : errors) error *= 100 / length_m;
      std::ranges::sort(errors);
      series.boxes.push_back({length_m, errors.front(), mesh_error::percentile(errors, 0.25),
                              mesh_error::percentile(errors, 0.5), mesh_error::percentile(errors, 0.75),
                              errors.back()});
    }
    chart.series.push_back(std::move(series));
  }
  cut_far_values(chart);
  return chart;
}

}  // namespace

std::vector<page::Chart> error_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<page::Chart> charts;
  add(charts, error_over_time(runs, buckets));
  add(charts, error_histogram(runs));
  add(charts, cumulative_errors(runs, buckets));
  add(charts, segment_boxes(runs));
  add(charts, error_and_sigma(runs, buckets));
  for (const char* part : {"position", "orientation"}) add(charts, consistency_chart(runs, buckets, part));
  return charts;
}

}  // namespace fusebench::run_charts
