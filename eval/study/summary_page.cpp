#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/report/page.hpp"
#include "eval/study/summary_formats.hpp"
#include "eval/suite_simulations.hpp"

namespace fusebench {

namespace {

PageTable page_table(const SummaryTable& table) {
  PageTable page{table.header, {}};
  for (const std::vector<std::string>& cells : table.rows) {
    const bool failed = cells.front() == to_string(Verdict::failed);
    page.rows.push_back({cells, failed ? "error" : ""});
  }
  return page;
}

/// Where a bin is drawn; the open one stands a bin's width behind its edge.
double place_px(const MotionBin& bin) {
  return std::isfinite(bin.to_px) ? (bin.from_px + bin.to_px) / 2 : bin.from_px + 5;
}

Chart motion_chart(const MotionCurve& curve) {
  Chart chart;
  chart.title = curve.group == kAllGroups ? "all groups" : curve.group;
  chart.x_label = "motion of patches between two frames [px]";
  chart.left_label = "AIE [grey levels]";
  chart.right_label = "dm / full";
  ChartSeries full{.label = "full", .points = {}};
  ChartSeries direct{.label = "dm", .points = {}};
  ChartSeries ratio{.label = "dm / full", .points = {}, .style = SeriesStyle::dots, .right = true};
  std::size_t frames = 0;
  for (const MotionBin& bin : curve.bins) {
    const SharedMeans& means = bin.means;
    if (means.frames == 0) continue;
    frames += means.frames;
    full.points.emplace_back(place_px(bin), means.reference_grey);
    direct.points.emplace_back(place_px(bin), means.variant_grey);
    ratio.points.emplace_back(place_px(bin), means.variant_grey / means.reference_grey);
  }
  chart.caption = fmt::format("On common pixels of {} frames; the last bin is 30 px and more.", frames);
  chart.series = {std::move(full), std::move(direct), std::move(ratio)};
  return chart;
}

/// A dot for each ok run; recordings are numbered as the suite has them.
Chart value_chart(const StudySummary& summary, const Study& study, std::string_view group,
                  const StudyValue& value) {
  Chart chart;
  chart.title = fmt::format("{}: {}", group, value.label);
  chart.x_label = "recording";
  chart.left_label = value.label;
  for (const std::string_view variant : {"full", "dm", "no-imu"}) {
    ChartSeries series{.label = std::string(variant), .points = {}, .style = SeriesStyle::dots};
    std::size_t place = 0;
    for (const StudyRun& run : study.runs) {
      if (run.group != group || run.variant != variant) continue;
      ++place;
      const auto number = value_of(study, run, value);
      if (number) series.points.emplace_back(static_cast<double>(place), *number * value.shown_factor);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  std::size_t lost = 0;
  for (const SummaryRow& row : summary.rows) lost += row.group == group ? row.total - row.ok : 0;
  chart.caption = fmt::format("Both halves; runs that are not ok have no dot ({} of all variants).", lost);
  return chart;
}

std::vector<Chart> value_charts(const StudySummary& summary, const Study& study) {
  std::vector<Chart> charts;
  std::vector<std::string> groups;
  for (const SummaryRow& row : summary.rows) {
    if (std::find(groups.begin(), groups.end(), row.group) == groups.end()) groups.push_back(row.group);
  }
  for (const std::string& group : groups) {
    for (const std::string_view name : {"ate_rmse_m", "aie_grey"}) {
      Chart chart = value_chart(summary, study, group, *find_study_value(name));
      if (!chart.series.empty()) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

}  // namespace

std::string summary_page(const StudySummary& summary, const Study& study) {
  Page page;
  page.title = fmt::format("Study: {}", summary.suite);
  std::size_t ok = 0;
  for (const StudyRun& run : study.runs) ok += run.record.status == RunStatus::ok ? 1 : 0;
  page.subtitle = fmt::format(
      "{} of {} runs ok. The tuning half is for choosing parameters, the held-out half for judging them.", ok,
      study.runs.size());
  if (!summary.bars.empty()) {
    SummaryTable bars = bar_table(summary.bars);
    page.sections.push_back({bars.title, "", page_table(bars)});
  }
  std::vector<Chart> motion;
  for (const MotionCurve& curve : summary.curves) {
    if (curve.half == kHeldOutHalf) motion.push_back(motion_chart(curve));
  }
  if (!motion.empty())
    page.sections.push_back({"AIE against image motion, held-out half", "", std::move(motion)});
  std::vector<Chart> charts = value_charts(summary, study);
  if (!charts.empty()) page.sections.push_back({"Each recording", "", std::move(charts)});
  for (const auto& tables : {value_tables(summary), motion_tables(summary)}) {
    for (const SummaryTable& table : tables) page.sections.push_back({table.title, "", page_table(table)});
  }
  return to_html(page);
}

}  // namespace fusebench
