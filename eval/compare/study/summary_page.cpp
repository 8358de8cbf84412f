#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/compare/study/summary_formats.hpp"
#include "eval/page/page.hpp"
#include "eval/page/series_colours.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::study {

namespace {

page::PageTable page_table(const SummaryTable& table) {
  page::PageTable page{table.header, {}};
  for (const std::vector<std::string>& cells : table.rows) {
    const bool failed = cells.front() == to_string(Verdict::failed);
    page.rows.push_back({cells, failed ? "error" : ""});
  }
  return page;
}

/// "1.20 / 1.18 / 1.90" one below the other, since a dozen of such columns are wider than a page; a column
/// says which line is the mean, the median and the worst.
page::PageTable stacked_table(const SummaryTable& table) {
  constexpr std::ptrdiff_t kNames = 2;  // group and variant
  page::PageTable page = page_table(table);
  const bool stacked = std::ranges::any_of(page.rows, [](const page::PageTable::Row& row) {
    return std::ranges::any_of(row.cells,
                               [](const std::string& cell) { return cell.find(" / ") != std::string::npos; });
  });
  if (!stacked) return page;
  page.header.insert(page.header.begin() + kNames, "over recordings");
  for (page::PageTable::Row& row : page.rows) {
    row.cells.insert(row.cells.begin() + kNames, "mean\nmedian\nworst");
    for (std::string& cell : row.cells) {
      for (auto at = cell.find(" / "); at != std::string::npos; at = cell.find(" / "))
        cell.replace(at, 3, "\n");
    }
  }
  return page;
}

/// Where a bin is drawn; the open one stands a bin's width behind its edge.
double place_px(const MotionBin& bin) {
  return std::isfinite(bin.to_px) ? (bin.from_px + bin.to_px) / 2 : bin.from_px + 5;
}

/// Of the variants that the suite names, charts show so many.
constexpr std::size_t kMostCharted = 3;

/// One a variant, as on other pages.
std::vector<std::size_t> colours_of(const std::vector<std::string>& variants) {
  std::vector<page::ColouredName> names;
  for (const std::string& variant : variants) names.push_back({variant, run_files::variant_rank(variant)});
  return page::series_colours(names);
}

page::ChartSeries series_of(const std::string& variant, std::size_t colour, page::SeriesStyle style) {
  return {.label = variant, .points = {}, .style = style, .colour = colour};
}

page::Chart motion_chart(const StudySummary& summary, const MotionCurve& curve) {
  page::Chart chart;
  chart.title = curve.group == kAllGroups ? "all groups" : curve.group;
  chart.x_label = "motion of patches between two frames [px]";
  chart.left_label = "AIE [grey levels]";
  chart.right_label = fmt::format("{} / {}", summary.partner, summary.reference);
  const std::vector<std::size_t> colours = colours_of({summary.reference, summary.partner});
  page::ChartSeries reference = series_of(summary.reference, colours[0], page::SeriesStyle::line);
  page::ChartSeries partner = series_of(summary.partner, colours[1], page::SeriesStyle::line);
  page::ChartSeries ratio{
      .label = chart.right_label, .points = {}, .style = page::SeriesStyle::dots, .right = true};
  ratio.colour = 7;  // grey
  std::size_t frames = 0;
  for (const MotionBin& bin : curve.bins) {
    const SharedMeans& means = bin.means;
    if (means.frames == 0) continue;
    frames += means.frames;
    reference.points.emplace_back(place_px(bin), means.reference_grey);
    partner.points.emplace_back(place_px(bin), means.variant_grey);
    ratio.points.emplace_back(place_px(bin), means.variant_grey / means.reference_grey);
  }
  chart.caption = fmt::format("On common pixels of {} frames; the last bin is 30 px and more.", frames);
  chart.series = {std::move(reference), std::move(partner), std::move(ratio)};
  return chart;
}

/// In the order in which the suite has them.
std::vector<std::string_view> recordings_of(const Study& study, std::string_view group) {
  std::vector<std::string_view> recordings;
  for (const StudyRun& run : study.runs) {
    const bool known = std::find(recordings.begin(), recordings.end(), run.recording) != recordings.end();
    if (run.group == group && !known) recordings.emplace_back(run.recording);
  }
  return recordings;
}

/// A dot for each ok run, above the name of its recording.
page::Chart value_chart(const StudySummary& summary, const Study& study, std::string_view group,
                        const registry::RunMetric& value) {
  page::Chart chart;
  chart.title = fmt::format("{}: {}", group, value.heading);
  chart.x_label = "recording";
  chart.left_label = value.heading;
  const std::vector<std::string_view> recordings = recordings_of(study, group);
  chart.x_names.assign(recordings.begin(), recordings.end());
  const std::vector<std::size_t> colours = colours_of(study.variants);
  for (std::size_t i = 0; i < std::min(study.variants.size(), kMostCharted); ++i) {
    const std::string& variant = study.variants[i];
    page::ChartSeries series = series_of(variant, colours[i], page::SeriesStyle::dots);
    for (const StudyRun& run : study.runs) {
      if (run.group != group || run.variant != variant) continue;
      const auto number = value_of(study, run, value);
      const auto place = std::find(recordings.begin(), recordings.end(), run.recording) - recordings.begin();
      if (number) series.points.emplace_back(static_cast<double>(place + 1), *number * value.shown_factor);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  std::size_t lost = 0;
  for (const SummaryRow& row : summary.rows) lost += row.group == group ? row.total - row.ok : 0;
  chart.caption = fmt::format("Both splits; runs that are not ok have no dot ({} of all variants).", lost);
  return chart;
}

std::vector<page::Chart> value_charts(const StudySummary& summary, const Study& study) {
  std::vector<page::Chart> charts;
  std::vector<std::string> groups;
  for (const SummaryRow& row : summary.rows) {
    if (std::find(groups.begin(), groups.end(), row.group) == groups.end()) groups.push_back(row.group);
  }
  for (const std::string& group : groups) {
    for (const std::string_view name : {"ate_rmse_m", "aie_grey"}) {
      page::Chart chart = value_chart(summary, study, group, registry::run_metric(name));
      if (!chart.series.empty()) charts.push_back(std::move(chart));
    }
  }
  return charts;
}

/// "Study demo: FAIL, 2 of 14 criteria failed".
std::string title_of(const StudySummary& summary) {
  if (summary.criteria.empty()) return fmt::format("Study {}", summary.suite);
  const auto count = [&](Verdict verdict) {
    return std::ranges::count_if(
        summary.criteria, [&](const CriterionResult& result) { return result.decided.verdict == verdict; });
  };
  const auto undecided = count(Verdict::not_applicable);
  const std::string rest = undecided > 0 ? fmt::format(", {} not decided", undecided) : "";
  if (const auto failed = count(Verdict::failed); failed > 0)
    return fmt::format("Study {}: FAIL, {} of {} criteria failed{}", summary.suite, failed,
                       summary.criteria.size(), rest);
  return fmt::format("Study {}: PASS, {} of {} criteria passed{}", summary.suite,
                     count(Verdict::passed) + count(Verdict::tied), summary.criteria.size(), rest);
}

}  // namespace

std::string summary_page(const StudySummary& summary, const Study& study) {
  page::Page page;
  page.title = title_of(summary);
  std::size_t ok = 0;
  for (const StudyRun& run : study.runs) ok += run.record.status == record::RunStatus::ok ? 1 : 0;
  page.subtitle = fmt::format(
      "{} of {} runs ok. The tuning split is for choosing parameters, the held-out split for judging them.",
      ok, study.runs.size());
  if (!summary.criteria.empty()) {
    page.subtitle += " " + criteria_verdict(summary.criteria);
    SummaryTable criteria = criteria_table(summary.criteria);
    page::PageTable table = page_table(criteria);
    table.sortable = true;
    page.sections.push_back({criteria.title, "", std::move(table)});
  }
  std::vector<page::Chart> motion;
  for (const MotionCurve& curve : summary.curves) {
    if (curve.split == suites::kHeldOutSplit) motion.push_back(motion_chart(summary, curve));
  }
  if (!motion.empty())
    page.sections.push_back({"AIE against image motion, held-out split", "", std::move(motion)});
  std::vector<page::Chart> charts = value_charts(summary, study);
  if (!charts.empty()) page.sections.push_back({"Each recording", "", std::move(charts)});
  for (const SummaryTable& table : value_tables(summary))
    page.sections.push_back({table.title, "", stacked_table(table)});
  for (const SummaryTable& table : motion_tables(summary))
    page.sections.push_back({table.title, "", page_table(table)});
  if (!summary.notes.empty()) {
    page::PageTable notes;
    for (const std::string& note : summary.notes) notes.rows.push_back({{note}, ""});
    page.sections.push_back({"Remarks", "", std::move(notes), 2, true});
  }
  return page::to_html(page);
}

}  // namespace fusebench::study
