#include "eval/report/results/run_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "core/geometry.hpp"
#include "eval/mesh/mesh_metrics.hpp"
#include "eval/trajectory/motion_pairs.hpp"
#include "eval/trajectory/segment_errors.hpp"

namespace fusebench {

namespace {

constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
constexpr double kCentimetres = 100;

Chart chart_of(std::string title, std::string x_label, std::string left_label, std::string caption = "") {
  Chart chart;
  chart.title = std::move(title);
  chart.caption = std::move(caption);
  chart.x_label = std::move(x_label);
  chart.left_label = std::move(left_label);
  return chart;
}

void add(std::vector<Chart>& charts, Chart chart) {
  std::erase_if(chart.series, [](const ChartSeries& s) { return s.points.empty() && s.boxes.empty(); });
  if (!chart.series.empty()) charts.push_back(std::move(chart));
}

/// Every so many of the points, the last among them: for curves that may run in any direction.
std::vector<Vector2d> strided(const std::vector<Vector2d>& points, std::size_t most) {
  const std::size_t step = points.size() / std::max<std::size_t>(most, 1) + 1;
  std::vector<Vector2d> result;
  for (std::size_t i = 0; i < points.size(); i += step) result.push_back(points[i]);
  if (!points.empty() && (points.size() - 1) % step != 0) result.push_back(points.back());
  return result;
}

/// The runs' colours come after that of the truth, also where the truth is not drawn.
std::size_t colour_of(std::size_t run) { return run + 1; }

const RunSeries* with_truth(std::span<const RunSeries> runs) {
  const auto found = std::ranges::find_if(runs, [](const RunSeries& run) { return !run.truth.empty(); });
  return found == runs.end() ? nullptr : &*found;
}

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

template <class Value>
std::vector<Vector2d> of_frames(const RunSeries& run, std::size_t buckets, const Value& value) {
  std::vector<Vector2d> points;
  for (const FrameTableRow& frame : run.frames) {
    const double y = value(frame);
    if (std::isfinite(y)) points.emplace_back(run.time_s(frame.timestamp_ns), y);
  }
  return thinned(points, buckets);
}

Chart view_chart(std::span<const RunSeries> runs, int across, int along, std::size_t buckets) {
  const auto name = [](int axis) { return kAxes[static_cast<std::size_t>(axis)]; };
  Chart chart = chart_of(fmt::format("{}-{} view", name(across), name(along)),
                         fmt::format("{} [m]", name(across)), fmt::format("{} [m]", name(along)));
  chart.from_zero = false;
  chart.equal_scale = true;
  const auto place = [&](const Vector3d& p) { return Vector2d(p[across], p[along]); };
  if (const RunSeries* run = with_truth(runs)) {
    chart.series.push_back(
        {"ground truth",
         strided(of_truth(*run, [&](const StampedPose& p) { return place(p.T_world_camera.translation); }),
                 2 * buckets),
         SeriesStyle::backdrop, false, 0});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto points =
        of_poses(runs[i], [&](const ComparedPose& p) { return place(p.T_truth_camera.translation); });
    chart.series.push_back(
        {runs[i].label, strided(points, 2 * buckets), SeriesStyle::line, false, colour_of(i)});
  }
  return chart;
}

Chart position_chart(std::span<const RunSeries> runs, int axis, std::size_t buckets) {
  Chart chart = chart_of(fmt::format("Position along {}", kAxes[static_cast<std::size_t>(axis)]), "time [s]",
                         fmt::format("{} [m]", kAxes[static_cast<std::size_t>(axis)]));
  chart.from_zero = false;
  if (const RunSeries* run = with_truth(runs)) {
    const auto points = of_truth(*run, [&](const StampedPose& p) {
      return Vector2d(run->time_s(p.timestamp_ns), p.T_world_camera.translation[axis]);
    });
    chart.series.push_back({"ground truth", thinned(points, buckets), SeriesStyle::backdrop, false, 0});
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto points = of_poses(runs[i], [&](const ComparedPose& p) {
      return Vector2d(runs[i].time_s(p.timestamp_ns), p.T_truth_camera.translation[axis]);
    });
    chart.series.push_back({runs[i].label, thinned(points, buckets), SeriesStyle::line, false, colour_of(i)});
  }
  return chart;
}

std::vector<double> errors_cm(const RunSeries& run) {
  std::vector<double> errors;
  for (const ComparedPose& pose : run.poses) {
    if (pose.T_truth_truth) errors.push_back(kCentimetres * pose.error_m);
  }
  std::ranges::sort(errors);
  return errors;
}

Chart error_over_time(std::span<const RunSeries> runs, std::size_t buckets) {
  Chart chart = chart_of("Position error", "time [s]", "error [cm]", "After the alignment of the ATE (SE3).");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::vector<Vector2d> points;
    for (const ComparedPose& pose : runs[i].poses) {
      if (pose.T_truth_truth)
        points.emplace_back(runs[i].time_s(pose.timestamp_ns), kCentimetres * pose.error_m);
    }
    chart.series.push_back({runs[i].label, thinned(points, buckets), SeriesStyle::line, false, colour_of(i)});
  }
  return chart;
}

Chart error_histogram(std::span<const RunSeries> runs) {
  constexpr std::size_t kBins = 30;
  Chart chart = chart_of("Histogram of position errors", "error [cm]", "share of frames [%]");
  double largest_cm = 0;
  for (const RunSeries& run : runs) {
    const auto errors = errors_cm(run);
    if (!errors.empty()) largest_cm = std::max(largest_cm, percentile(errors, 0.98));
  }
  if (largest_cm <= 0) return chart;
  chart.caption = fmt::format("{} bins; the last one holds everything beyond.", kBins);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto errors = errors_cm(runs[i]);
    if (errors.empty()) continue;
    std::array<double, kBins> counts{};
    for (const double error_cm : errors) {
      const auto bin = static_cast<std::size_t>(static_cast<double>(kBins) * error_cm / largest_cm);
      ++counts[std::min(bin, kBins - 1)];
    }
    ChartSeries series{runs[i].label, {}, SeriesStyle::bars, false, colour_of(i)};
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      series.points.emplace_back((static_cast<double>(bin) + 0.5) * largest_cm / static_cast<double>(kBins),
                                 100 * counts[bin] / static_cast<double>(errors.size()));
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart cumulative_errors(std::span<const RunSeries> runs, std::size_t buckets) {
  Chart chart = chart_of(
      "Cumulative position error", "error [cm]", "share of all frames [%]",
      "Share of the recording's frames whose error is smaller. A curve that ends below 100 % has lost "
      "frames.");
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto errors = errors_cm(runs[i]);
    std::vector<Vector2d> points;
    const double all = static_cast<double>(std::max<std::size_t>(runs[i].run->record.frames.total, 1));
    for (std::size_t k = 0; k < errors.size(); ++k)
      points.emplace_back(errors[k], 100 * static_cast<double>(k + 1) / all);
    chart.series.push_back({runs[i].label, strided(points, buckets), SeriesStyle::line, false, colour_of(i)});
  }
  return chart;
}

/// By the first pose in place of an alignment: the filter's certainty counts from there.
Chart error_and_sigma(std::span<const RunSeries> runs, std::size_t buckets) {
  Chart chart =
      chart_of("Drift against the filter's own 3 sigma", "time [s]", "distance [cm]",
               "Position relative to the first frame, without alignment; 3 sigma of the longest axis.");
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
    chart.series.push_back({runs[i].label, thinned(drift, buckets), SeriesStyle::line, false, colour_of(i)});
    chart.series.push_back({runs[i].label + ", 3 sigma",
                            of_frames(runs[i], buckets / 8 + 1,
                                      [](const FrameTableRow& f) {
                                        return f.status == "lost" ? std::nan("")
                                                                  : 3 * kCentimetres * f.position_sigma_m;
                                      }),
                            SeriesStyle::dots, false, colour_of(i)});
  }
  return chart;
}

/// Logarithmic, since an overconfident filter is off by orders of magnitude.
Chart consistency_chart(std::span<const RunSeries> runs, std::size_t buckets, std::string_view part) {
  Chart chart = chart_of(
      fmt::format("Consistency of the {}", part), "time [s]", "log10 (NEES / 3)",
      "An honest covariance has a mean NEES / 3 of 1, the 0 here; much above, it is too sure of itself.");
  chart.from_zero = false;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::vector<Vector2d> points;
    for (const NeesTableRow& row : runs[i].nees) {
      if (row.part == part && row.nees_per_dof > 0)
        points.emplace_back(runs[i].time_s(row.capture_ns), std::log10(row.nees_per_dof));
    }
    chart.series.push_back({runs[i].label, thinned(points, buckets), SeriesStyle::line, false, colour_of(i)});
  }
  return chart;
}

TrajectoryPair pair_of(const RunSeries& run) {
  TrajectoryPair pair;
  for (const ComparedPose& pose : run.poses) {
    if (!pose.T_truth_truth) continue;
    pair.reference.push_back({pose.timestamp_ns, *pose.T_truth_truth});
    pair.estimate.push_back({pose.timestamp_ns, pose.T_truth_camera});
  }
  return pair;
}

Chart segment_boxes(std::span<const RunSeries> runs) {
  Chart chart = chart_of(
      "Relative error over segments of the path", "length of the segment [m]",
      "translation error [% of the length]",
      "Boxes from the lower to the upper quartile with the median; whiskers to the extremes. Lengths are "
      "10 to 50 % of the true path (rpg_trajectory_evaluation).");
  const RunSeries* const known = with_truth(runs);
  const std::vector<double> lengths = known != nullptr ? rpg_lengths(known->truth) : std::vector<double>();
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const TrajectoryPair pair = pair_of(runs[i]);
    if (pair.size() < 2) continue;
    ChartSeries series{runs[i].label, {}, SeriesStyle::boxes, false, colour_of(i)};
    for (const double length_m : lengths) {
      if (!(length_m > 0)) continue;
      const IndexPairs segments = rpg_motions(pair.reference, length_m, /*as_published=*/false);
      if (segments.empty()) continue;
      std::vector<double> errors = segment_errors(pair, segments, length_m).translation_m;
      for (double& error : errors) error *= 100 / length_m;
      std::ranges::sort(errors);
      series.boxes.push_back({length_m, errors.front(), percentile(errors, 0.25), percentile(errors, 0.5),
                              percentile(errors, 0.75), errors.back()});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Of the true camera where it is known, else of the first run's estimate.
struct Speeds {
  std::string source;
  std::vector<Vector2d> linear_mps;
  std::vector<Vector2d> angular_degps;
};

Speeds speeds_of(std::span<const RunSeries> runs, std::size_t buckets) {
  Speeds speeds;
  if (const RunSeries* run = with_truth(runs)) {
    speeds.source = "ground truth";
    for (std::size_t i = 1; i < run->truth.size(); ++i) {
      const StampedPose& before = run->truth[i - 1];
      const StampedPose& after = run->truth[i];
      const double step_s = seconds_between(before.timestamp_ns, after.timestamp_ns);
      const SE3 motion = before.T_world_camera.inverse() * after.T_world_camera;
      const double time_s = run->time_s(after.timestamp_ns);
      speeds.linear_mps.emplace_back(time_s, motion.translation.norm() / step_s);
      speeds.angular_degps.emplace_back(time_s, degrees(so3_log(motion.rotation).norm()) / step_s);
    }
    speeds.linear_mps = thinned(speeds.linear_mps, buckets);
    speeds.angular_degps = thinned(speeds.angular_degps, buckets);
  } else if (!runs.empty()) {
    speeds.source = "estimate of " + runs.front().label;
    speeds.linear_mps = of_frames(runs.front(), buckets, [](const FrameTableRow& f) { return f.speed_mps; });
    speeds.angular_degps = of_frames(runs.front(), buckets,
                                     [](const FrameTableRow& f) { return degrees(f.angular_speed_radps); });
  }
  return speeds;
}

template <class Value>
Chart frame_chart(std::span<const RunSeries> runs, std::size_t buckets, Chart chart, const Value& value) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    chart.series.push_back(
        {runs[i].label, of_frames(runs[i], buckets, value), SeriesStyle::line, false, colour_of(i)});
  }
  return chart;
}

std::string health_text(const RunSeries& run) {
  std::map<std::string, std::size_t> counts;
  for (const FrameTableRow& frame : run.frames) {
    const bool tracked = frame.status != "lost";
    ++counts[tracked ? frame.health : "lost (" + frame.health + ")"];
  }
  std::string text = run.label + ":";
  for (const auto& [health, count] : counts) text += fmt::format(" {} {},", count, health);
  text.back() = '.';
  return text;
}

Chart health_chart(std::span<const RunSeries> runs, std::size_t buckets) {
  Chart chart =
      frame_chart(runs, buckets, chart_of("Accepted patches and lost frames", "time [s]", "patches"),
                  [](const FrameTableRow& f) { return f.patches_accepted; });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto lost = of_frames(
        runs[i], buckets, [](const FrameTableRow& f) { return f.status == "lost" ? 0.0 : std::nan(""); });
    if (!lost.empty())
      chart.series.push_back({runs[i].label + ", lost", lost, SeriesStyle::dots, false, colour_of(i)});
    if (!runs[i].frames.empty())
      chart.caption += (chart.caption.empty() ? "Frames: " : " ") + health_text(runs[i]);
  }
  return chart;
}

Chart stage_chart(std::span<const RunSeries> runs) {
  Chart chart = chart_of("Time of the stages", "", "mean time a frame [ms]",
                         "On the machine of the run; times of different machines do not compare.");
  std::vector<const RunSeries*> timed;  // imported runs are not
  std::vector<std::string> stages;
  for (const RunSeries& run : runs) {
    if (run.run->record.timing.stages_ms.empty()) continue;
    timed.push_back(&run);
    chart.categories.push_back(run.label);
    for (const auto& [stage, ms] : run.run->record.timing.stages_ms) {
      if (stage != "mesh_once" && std::ranges::find(stages, stage) == stages.end()) stages.push_back(stage);
    }
  }
  for (const std::string& stage : stages) {
    ChartSeries series{stage, {}, SeriesStyle::bars};
    for (std::size_t i = 0; i < timed.size(); ++i) {
      for (const auto& [name, ms] : timed[i]->run->record.timing.stages_ms) {
        if (name == stage) series.points.emplace_back(static_cast<double>(i), ms);
      }
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

std::vector<Chart> view_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<Chart> charts;
  add(charts, view_chart(runs, 0, 1, buckets));
  add(charts, view_chart(runs, 0, 2, buckets));
  add(charts, view_chart(runs, 1, 2, buckets));
  return charts;
}

std::vector<Chart> position_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<Chart> charts;
  for (const int axis : {0, 1, 2}) add(charts, position_chart(runs, axis, buckets));
  return charts;
}

std::vector<Chart> error_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<Chart> charts;
  add(charts, error_over_time(runs, buckets));
  add(charts, error_histogram(runs));
  add(charts, cumulative_errors(runs, buckets));
  add(charts, segment_boxes(runs));
  add(charts, error_and_sigma(runs, buckets));
  for (const char* part : {"position", "orientation"}) add(charts, consistency_chart(runs, buckets, part));
  return charts;
}

std::vector<Chart> motion_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<Chart> charts;
  Speeds speeds = speeds_of(runs, buckets);
  Chart linear = chart_of("Linear speed of the camera", "time [s]", "speed [m/s]");
  linear.series.push_back({speeds.source, std::move(speeds.linear_mps)});
  add(charts, std::move(linear));
  Chart angular = chart_of("Angular speed of the camera", "time [s]", "angular speed [deg/s]");
  angular.series.push_back({speeds.source, std::move(speeds.angular_degps)});
  add(charts, std::move(angular));
  add(charts, frame_chart(runs, buckets,
                          chart_of("Motion of the patches", "time [s]", "motion since the last frame [px]",
                                   "Median of the frame's tracked patches."),
                          [](const FrameTableRow& f) { return f.patch_motion_px; }));
  add(charts, frame_chart(runs, buckets,
                          chart_of("Average intensity error", "time [s]", "AIE [grey levels]",
                                   "Of each frame's tracked patches, before any rejection."),
                          [](const FrameTableRow& f) { return f.aie_grey.value_or(std::nan("")); }));
  return charts;
}

std::vector<Chart> tracking_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<Chart> charts;
  add(charts, health_chart(runs, buckets));
  add(charts, stage_chart(runs));
  return charts;
}

}  // namespace fusebench
