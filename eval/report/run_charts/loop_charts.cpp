#include "eval/report/run_charts/loop_charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "eval/report/run_charts/chart_parts.hpp"

namespace fusebench::run_charts {

namespace {

using run_files::CandidateFate;
using run_files::CandidateRow;

constexpr std::size_t kOnlineColour = 1;
constexpr std::size_t kFinalColour = 2;

/// What a reader sees of each fate; what comes later lies on top.
struct FateSeries {
  CandidateFate fate;
  const char* label;
  std::size_t colour;
};
constexpr std::array kFates = {
    FateSeries{CandidateFate::no_pose, "refused: no certain pose", 7},
    FateSeries{CandidateFate::depth_differs, "refused: depth does not fit", 4},
    FateSeries{CandidateFate::poses_differ, "refused: contradicts the poses", 1},
    FateSeries{CandidateFate::accepted_by_tracker, "accepted: found by the tracker", 5},
    FateSeries{CandidateFate::accepted_by_depth, "accepted by depth alone", 0},
    FateSeries{CandidateFate::accepted_by_features, "accepted by features", 2}};

/// What is drawn of many: every so many of them, which the label says.
std::size_t step_for(std::size_t count, std::size_t most) {
  return std::max<std::size_t>(1, (count + most - 1) / std::max<std::size_t>(most, 1));
}
std::string counted_label(const std::string& name, std::size_t count, std::size_t step) {
  return step > 1 ? fmt::format("{} ({}, one in {} drawn)", name, count, step)
                  : fmt::format("{} ({})", name, count);
}

/// Stamps of the tables of loops are rounded to microseconds. Null if there is no pose then.
const ComparedPose* pose_at(const std::vector<ComparedPose>& poses, std::int64_t timestamp_ns) {
  constexpr std::int64_t kRounding_ns = 2'000;
  const auto found =
      std::ranges::lower_bound(poses, timestamp_ns - kRounding_ns, {}, &ComparedPose::timestamp_ns);
  if (found == poses.end() || found->timestamp_ns > timestamp_ns + kRounding_ns) return nullptr;
  return &*found;
}

const std::vector<ComparedPose>& last_poses(const RunSeries& run) {
  return run.final_poses.empty() ? run.poses : run.final_poses;
}

template <class Kind, class Place>
page::ChartSeries lines_between_places(const RunSeries& run, const std::string& name, std::size_t colour,
                                       std::size_t most, const Kind& is_of_kind, const Place& place) {
  std::vector<std::pair<Vector2d, Vector2d>> lines;
  for (const CandidateRow& candidate : run.candidates) {
    if (!is_of_kind(candidate)) continue;
    const ComparedPose* const from = pose_at(last_poses(run), candidate.place_ns);
    const ComparedPose* const to = pose_at(last_poses(run), candidate.query_ns);
    if (from != nullptr && to != nullptr)
      lines.emplace_back(place(from->T_truth_camera.translation), place(to->T_truth_camera.translation));
  }
  const std::size_t step = step_for(lines.size(), most);
  page::ChartSeries series{
      counted_label(name, lines.size(), step), {}, page::SeriesStyle::segments, false, colour};
  for (std::size_t i = 0; i < lines.size(); i += step) {
    series.points.push_back(lines[i].first);
    series.points.push_back(lines[i].second);
  }
  return series;
}

page::Chart loop_view_chart(const RunSeries& run, int across, int along, std::size_t buckets) {
  constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};
  const auto name = [&](int axis) { return kAxes[static_cast<std::size_t>(axis)]; };
  const char* const what =
      run.final_poses.empty() || !run.candidates.empty() ? "with loops" : "before and after";
  page::Chart chart = chart_of(fmt::format("{}-{} view {}: {}", name(across), name(along), what, run.label),
                               fmt::format("{} [m]", name(across)), fmt::format("{} [m]", name(along)));
  chart.from_zero = false;
  chart.equal_scale = true;
  const auto place = [&](const Vector3d& p) { return Vector2d(p[across], p[along]); };
  const auto path = [&](const std::vector<ComparedPose>& poses) {
    std::vector<Vector2d> points;
    for (const ComparedPose& pose : poses) points.push_back(place(pose.T_truth_camera.translation));
    return strided(points, 2 * buckets);
  };
  std::vector<Vector2d> truth;
  for (const StampedPose& pose : run.truth) truth.push_back(place(pose.T_world_camera.translation));
  chart.series.push_back(
      {"ground truth", strided(truth, 2 * buckets), page::SeriesStyle::backdrop, false, 0});
  chart.series.push_back({run.final_poses.empty() ? "online" : "before (online)", path(run.poses),
                          page::SeriesStyle::line, false, kOnlineColour});
  chart.series.push_back(
      {"after (final)", path(run.final_poses), page::SeriesStyle::line, false, kFinalColour});
  chart.series.push_back(lines_between_places(
      run, "accepted loops", 3, buckets, [](const CandidateRow& c) { return c.is_accepted(); }, place));
  chart.series.push_back(lines_between_places(
      run, "contradict the poses", 5, buckets,
      [](const CandidateRow& c) { return c.fate == CandidateFate::poses_differ; }, place));
  chart.series.back().on_request = true;
  chart.series.push_back(lines_between_places(
      run, "refused, others", 7, buckets,
      [](const CandidateRow& c) { return !c.is_accepted() && c.fate != CandidateFate::poses_differ; },
      place));
  chart.series.back().on_request = true;
  return chart;
}

page::Chart candidate_chart(const RunSeries& run, std::size_t buckets) {
  page::Chart chart = chart_of(fmt::format("Candidates for loops: {}", run.label),
                               "time of the new place [s]", "time of the older place [s]",
                               "A dot a pair of places that look alike, or see the same by the poses so far. "
                               "Dots along a diagonal: the camera follows its earlier path.");
  for (const FateSeries& fate : kFates) {
    std::vector<Vector2d> points;
    for (const CandidateRow& candidate : run.candidates) {
      if (candidate.fate == fate.fate)
        points.emplace_back(run.time_s(candidate.query_ns), run.time_s(candidate.place_ns));
    }
    const std::size_t step = step_for(points.size(), 2 * buckets);
    page::ChartSeries series{
        counted_label(fate.label, points.size(), step), {}, page::SeriesStyle::dots, false, fate.colour};
    for (std::size_t i = 0; i < points.size(); i += step) series.points.push_back(points[i]);
    chart.series.push_back(std::move(series));
  }
  return chart;
}

page::Chart blur_chart(const RunSeries& run, std::size_t buckets) {
  page::Chart chart =
      chart_of(fmt::format("Motion blur of the places: {}", run.label), "time [s]", "motion blur [px]",
               "A dot a place, by what came of comparing it with older ones.");
  const auto of = [&](const char* label, std::size_t colour, const auto& is_of_kind) {
    std::vector<Vector2d> points;
    for (const run_files::PlaceRow& place : run.places) {
      if (is_of_kind(place)) points.emplace_back(run.time_s(place.timestamp_ns), place.blur_px);
    }
    chart.series.push_back({counted_label(label, points.size(), 1), page::thinned(points, buckets),
                            page::SeriesStyle::dots, false, colour});
  };
  of("with a loop", 2, [](const run_files::PlaceRow& p) { return p.accepted > 0; });
  of("candidates, but no loop", 1,
     [](const run_files::PlaceRow& p) { return p.accepted == 0 && p.candidates > 0; });
  of("no candidate", 7, [](const run_files::PlaceRow& p) { return p.candidates == 0; });
  return chart;
}

page::Chart error_chart(const RunSeries& run, std::size_t buckets) {
  page::Chart chart = chart_of(fmt::format("Position error before and after: {}", run.label), "time [s]",
                               "error [cm]", "Each after its own alignment, that of its ATE (SE3).");
  const auto of = [&](const std::vector<ComparedPose>& poses) {
    std::vector<Vector2d> points;
    for (const ComparedPose& pose : poses) {
      if (pose.T_truth_truth) points.emplace_back(run.time_s(pose.timestamp_ns), kCentimetres * pose.error_m);
    }
    return page::thinned(points, buckets);
  };
  if (run.final_poses.empty()) return chart;
  chart.series.push_back({"before (online)", of(run.poses), page::SeriesStyle::line, false, kOnlineColour});
  chart.series.push_back(
      {"after (final)", of(run.final_poses), page::SeriesStyle::line, false, kFinalColour});
  return chart;
}

page::Chart movement_chart(const RunSeries& run, std::size_t buckets) {
  page::Chart chart =
      chart_of(fmt::format("How far the poses moved: {}", run.label), "time [s]", "distance [cm]",
               "Between the online and the final position of a frame, both relative to the first frame.");
  if (run.poses.empty() || run.final_poses.empty()) return chart;
  const SE3 T_start_online = run.poses.front().T_truth_camera.inverse();
  const SE3 T_start_final = run.final_poses.front().T_truth_camera.inverse();
  std::vector<Vector2d> points;
  for (const ComparedPose& after : run.final_poses) {
    const ComparedPose* const before = pose_at(run.poses, after.timestamp_ns);
    if (before == nullptr) continue;
    const Vector3d moved = T_start_final * after.T_truth_camera.translation -
                           T_start_online * before->T_truth_camera.translation;
    points.emplace_back(run.time_s(after.timestamp_ns), kCentimetres * moved.norm());
  }
  chart.series.push_back(
      {"final against online", page::thinned(points, buckets), page::SeriesStyle::line, false, kFinalColour});
  return chart;
}

}  // namespace

std::vector<page::Chart> loop_view_charts(const RunSeries& run, std::size_t buckets) {
  std::vector<page::Chart> charts;
  for (const auto& [across, along] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}})
    add(charts, loop_view_chart(run, across, along, buckets));
  return charts;
}

std::vector<page::Chart> loop_time_charts(const RunSeries& run, std::size_t buckets) {
  std::vector<page::Chart> charts;
  add(charts, candidate_chart(run, buckets));
  add(charts, blur_chart(run, buckets));
  add(charts, error_chart(run, buckets));
  add(charts, movement_chart(run, buckets));
  return charts;
}

}  // namespace fusebench::run_charts
