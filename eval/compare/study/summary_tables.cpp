#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/compare/study/summary_formats.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::study {

namespace {

using Cells = std::vector<std::string>;

/// The unit of what a criterion measures, with a space before it; none of ratios, shares and counts.
std::string unit_of(const suites::Criterion& criterion) {
  if (criterion.statistic == suites::CriterionStatistic::share) return "";
  if (!criterion.against.empty() && criterion.compare == suites::CriterionComparison::ratio) return "";
  const std::string_view unit = registry::run_metric(criterion.metric).unit;
  return unit == "1" ? "" : fmt::format(" {}", unit);
}

/// "1.20 / 1.18 / 1.90": mean, median, worst.
std::string spread_cell(const ValueSpread& spread, const registry::RunMetric& metric) {
  if (spread.count == 0) return "-";
  const auto shown = [&](double number) { return registry::shown_text(metric, number); };
  return fmt::format("{} / {} / {}", shown(spread.mean), shown(spread.median), shown(spread.worst));
}

std::string nees_cell(const ValueSpread& spread) {
  if (spread.count == 0 || !spread.bounds_95) return "-";
  const char* verdict = spread.mean > spread.bounds_95->upper   ? " overconfident"
                        : spread.mean < spread.bounds_95->lower ? " underconfident"
                                                                : "";
  return fmt::format("{:.2f} ({:.2f} .. {:.2f}){}", spread.mean, spread.bounds_95->lower,
                     spread.bounds_95->upper, verdict);
}

std::string common_cell(const ValueSpread& spread) {
  if (spread.count == 0) return "-";
  return fmt::format("{:.2f} ({} {:.2f})", spread.mean, spread.partner, spread.partner_mean);
}

std::string counts_cell(const SummaryRow& row) {
  std::string text = fmt::format("{}/{}", row.ok, row.total);
  if (row.lost > 0) text += fmt::format(", {} lost", row.lost);
  return text;
}

bool any_value(const std::vector<const SummaryRow*>& rows, std::size_t index) {
  return std::any_of(rows.begin(), rows.end(),
                     [&](const SummaryRow* row) { return row->values[index].count > 0; });
}

std::vector<const SummaryRow*> rows_of(const StudySummary& summary, std::string_view split) {
  std::vector<const SummaryRow*> rows;
  for (const SummaryRow& row : summary.rows) {
    if (row.split == split) rows.push_back(&row);
  }
  return rows;
}

SummaryTable value_table(std::string_view split, const std::vector<const SummaryRow*>& rows) {
  SummaryTable table{fmt::format("Runs, {} split: mean / median / worst over recordings", split),
                     {"group", "variant", "ok", "lost frames"},
                     {}};
  for (const SummaryRow* row : rows) {
    table.rows.push_back(
        {row->group, row->variant, counts_cell(*row), fmt::format("{}/{}", row->lost_frames, row->frames)});
  }
  const auto metrics = registry::columns_of(registry::Column::study);
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    const bool told = metrics[i]->key == "runs_not_ok" || metrics[i]->key == "frames_lost";
    if (told || metrics[i]->nees_dof > 0 || !any_value(rows, i)) continue;
    table.header.emplace_back(metrics[i]->heading);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const ValueSpread& spread = rows[k]->values[i];
      table.rows[k].push_back(metrics[i]->takes_several_runs() ? common_cell(spread)
                                                               : spread_cell(spread, *metrics[i]));
    }
  }
  return table;
}

SummaryTable nees_table(std::string_view split, const std::vector<const SummaryRow*>& rows) {
  SummaryTable table{
      fmt::format(
          "NEES / dof, {} split: mean over runs (95 % bounds of that mean). Overconfident: errors are "
          "larger than the covariance claims; underconfident: smaller",
          split),
      {"group", "variant"},
      {}};
  const auto metrics = registry::columns_of(registry::Column::study);
  for (const SummaryRow* row : rows) {
    Cells cells = {row->group, row->variant};
    bool any = false;
    for (std::size_t i = 0; i < metrics.size(); ++i) {
      if (metrics[i]->nees_dof == 0) continue;
      cells.push_back(nees_cell(row->values[i]));
      any = any || row->values[i].count > 0;
    }
    if (any) table.rows.push_back(std::move(cells));
  }
  for (const registry::RunMetric* metric : metrics) {
    if (metric->nees_dof > 0) table.header.emplace_back(metric->heading);
  }
  return table;
}

/// "PASS"; of what no run has a number of: "not decided".
std::string verdict_cell(Verdict verdict) {
  return verdict == Verdict::not_applicable ? "not decided" : std::string(to_string(verdict));
}

std::string number_cell(const std::optional<double>& value, const std::string& unit) {
  return value ? fmt::format("{:.4g}{}", *value, unit) : "-";
}

/// "tuning: 0.012 (PASS, 4 recordings)"; blank where that split has no number.
std::string beside_cell(const CriterionMeasurement& beside, const std::string& unit) {
  if (beside.verdict == Verdict::not_applicable) return "";
  return fmt::format("{}: {} ({}, {} recording{})", beside.split, number_cell(beside.measured, unit),
                     to_string(beside.verdict), beside.recordings, beside.recordings == 1 ? "" : "s");
}

}  // namespace

SummaryTable criteria_table(const std::vector<CriterionResult>& criteria) {
  SummaryTable table{
      "Acceptance criteria",
      {"verdict", "criterion", "groups", "measured", "limit", "recordings", "other split", "remarks"},
      {}};
  for (const CriterionResult& result : criteria) {
    std::string groups;
    const std::string unit = unit_of(result.criterion);
    for (const std::string& group : result.criterion.groups) groups += (groups.empty() ? "" : " ") + group;
    table.rows.push_back({verdict_cell(result.decided.verdict), result.criterion.title,
                          groups.empty() ? std::string(kAllGroups) : groups,
                          number_cell(result.decided.measured, unit),
                          result.decided.limit.empty() ? "" : result.decided.limit + unit,
                          fmt::format("{}", result.decided.recordings), beside_cell(result.beside, unit),
                          result.decided.note});
  }
  return table;
}

std::vector<SummaryTable> value_tables(const StudySummary& summary) {
  std::vector<SummaryTable> tables;
  for (const std::string_view split : {suites::kHeldOutSplit, suites::kTuningSplit}) {
    const std::vector<const SummaryRow*> rows = rows_of(summary, split);
    if (rows.empty()) continue;
    tables.push_back(value_table(split, rows));
    SummaryTable nees = nees_table(split, rows);
    if (!nees.rows.empty()) tables.push_back(std::move(nees));
  }
  return tables;
}

std::vector<SummaryTable> motion_tables(const StudySummary& summary) {
  std::vector<SummaryTable> tables;
  for (const std::string_view split : {suites::kHeldOutSplit, suites::kTuningSplit}) {
    SummaryTable table{
        fmt::format("AIE on common pixels against the motion of patches between two frames, {} split", split),
        {"group", "motion [px]", "frames", "pixels", summary.reference, summary.partner,
         fmt::format("{} / {}", summary.partner, summary.reference)},
        {}};
    for (const MotionCurve& curve : summary.curves) {
      if (curve.split != split) continue;
      for (const MotionBin& bin : curve.bins) {
        const SharedMeans& means = bin.means;
        if (means.frames == 0) continue;
        table.rows.push_back({curve.group,
                              std::isfinite(bin.to_px) ? fmt::format("{:g} to {:g}", bin.from_px, bin.to_px)
                                                       : fmt::format("{:g} and more", bin.from_px),
                              fmt::format("{}", means.frames), fmt::format("{}", means.pixels),
                              fmt::format("{:.2f}", means.reference_grey),
                              fmt::format("{:.2f}", means.variant_grey),
                              fmt::format("{:.2f}", means.variant_grey / means.reference_grey)});
      }
    }
    if (!table.rows.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace fusebench::study
