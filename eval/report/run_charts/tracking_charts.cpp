#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/base/geometry.hpp"
#include "eval/report/run_charts/chart_parts.hpp"
#include "eval/report/run_charts/run_charts.hpp"

namespace fusebench::run_charts {

namespace {

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
    speeds.linear_mps = page::thinned(speeds.linear_mps, buckets);
    speeds.angular_degps = page::thinned(speeds.angular_degps, buckets);
  } else if (!runs.empty()) {
    speeds.source = "estimate of " + runs.front().label;
    speeds.linear_mps =
        of_frames(runs.front(), buckets, [](const run_files::FrameTableRow& f) { return f.speed_mps; });
    speeds.angular_degps = of_frames(runs.front(), buckets, [](const run_files::FrameTableRow& f) {
      return degrees(f.angular_speed_radps);
    });
  }
  return speeds;
}

template <class Value>
page::Chart frame_chart(std::span<const RunSeries> runs, std::size_t buckets, page::Chart chart,
                        const Value& value) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    chart.series.push_back(
        {runs[i].label, of_frames(runs[i], buckets, value), page::SeriesStyle::line, false, runs[i].colour});
  }
  cut_far_values(chart);
  return chart;
}

std::string health_text(const RunSeries& run) {
  std::map<std::string, std::size_t> counts;
  for (const run_files::FrameTableRow& frame : run.frames) {
    ++counts[frame.is_in_map() ? frame.health : frame.status + " (" + frame.health + ")"];
  }
  std::string text = run.label + ":";
  for (const auto& [health, count] : counts)
    text += fmt::format(" {}{}{},", count, health.empty() ? "" : " ", health);
  text.back() = '.';
  return text;
}

page::Chart health_chart(std::span<const RunSeries> runs, std::size_t buckets) {
  page::Chart chart =
      frame_chart(runs, buckets, chart_of("Accepted patches and lost frames", "time [s]", "patches"),
                  [](const run_files::FrameTableRow& f) { return f.patches_accepted; });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto lost = of_frames(runs[i], buckets, [](const run_files::FrameTableRow& f) {
      return f.status == "lost" ? 0.0 : std::nan("");
    });
    if (!lost.empty())
      chart.series.push_back(
          {runs[i].label + ", lost", lost, page::SeriesStyle::dots, false, runs[i].colour});
    if (!runs[i].frames.empty())
      chart.caption += (chart.caption.empty() ? "Frames: " : " ") + health_text(runs[i]);
  }
  return chart;
}

page::Chart stage_chart(std::span<const RunSeries> runs) {
  page::Chart chart = chart_of("Time of the stages", "", "mean time a frame [ms]",
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
    page::ChartSeries series{stage, {}, page::SeriesStyle::bars};
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

std::vector<page::Chart> motion_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<page::Chart> charts;
  Speeds speeds = speeds_of(runs, buckets);
  page::Chart linear = chart_of("Linear speed of the camera", "time [s]", "speed [m/s]");
  linear.series.push_back({speeds.source, std::move(speeds.linear_mps)});
  add(charts, std::move(linear));
  page::Chart angular = chart_of("Angular speed of the camera", "time [s]", "angular speed [deg/s]");
  angular.series.push_back({speeds.source, std::move(speeds.angular_degps)});
  add(charts, std::move(angular));
  add(charts, frame_chart(runs, buckets,
                          chart_of("Motion of the patches", "time [s]", "motion since the last frame [px]",
                                   "Median of the frame's tracked patches."),
                          [](const run_files::FrameTableRow& f) { return f.patch_motion_px; }));
  add(charts,
      frame_chart(runs, buckets,
                  chart_of("Average intensity error", "time [s]", "AIE [grey levels]",
                           "Of each frame's tracked patches, before any rejection."),
                  [](const run_files::FrameTableRow& f) { return f.aie_grey.value_or(std::nan("")); }));
  return charts;
}

std::vector<page::Chart> tracking_charts(std::span<const RunSeries> runs, std::size_t buckets) {
  std::vector<page::Chart> charts;
  add(charts, health_chart(runs, buckets));
  add(charts, stage_chart(runs));
  return charts;
}

}  // namespace fusebench::run_charts
