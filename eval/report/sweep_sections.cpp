#include "eval/report/sweep_sections.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "eval/compare/aggregate/best.hpp"
#include "eval/compare/aggregate/configurations.hpp"
#include "eval/compare/aggregate/effects.hpp"
#include "eval/compare/aggregate/option_bins.hpp"
#include "eval/compare/aggregate/pareto.hpp"
#include "eval/record/registry/run_metric.hpp"
#include "eval/report/sweep_charts.hpp"

namespace fusebench::report {

namespace {

/// The numbers that a sweep is ranked by: the first two that the runs have.
constexpr std::array<std::string_view, 4> kMetrics = {"ate", "aie", "mesh", "rpe"};
constexpr std::size_t kMostMetrics = 2;

bool is_swept(std::span<const aggregate::RunRow> rows) {
  for (const std::string& key : aggregate::edited_options(rows)) {
    std::set<std::string> values;
    for (const aggregate::RunRow& row : rows) {
      if (row.attributable()) values.emplace(aggregate::option_of(row, key));
    }
    if (values.size() > 1) return true;
  }
  return false;
}

bool has(std::span<const aggregate::RunRow> rows, const registry::RunMetric& metric) {
  for (const aggregate::RunRow& row : rows) {
    if (row.status == record::RunStatus::ok && row.numbers[metric]) return true;
  }
  return false;
}

void add(std::vector<page::PageSection>& sections, std::string title, std::string text,
         std::vector<page::Chart> charts, bool folded) {
  if (!charts.empty()) sections.push_back({std::move(title), std::move(text), std::move(charts), 3, folded});
}

page::PageSection best_section(const aggregate::BestTable& table) {
  page::PageTable page;
  page.sortable = true;
  page.header = {"recordings",     "rank",           "variant",
                 "edited options", "times the best", "mean " + std::string(table.metric->heading),
                 "runs ok"};
  for (const aggregate::BestGroup& group : table.groups) {
    for (const aggregate::BestRow& row : group.rows) {
      const aggregate::ConfigurationSummary& c = row.configuration;
      std::string options;
      for (const auto& [key, value] : c.options)
        options += fmt::format("{}{} = {}", options.empty() ? "" : ", ", key, value);
      page.rows.push_back(
          {{fmt::format("{}", group.recordings.size()), row.rank ? fmt::format("{}", *row.rank) : "-",
            c.variant, options, c.ratio.ratio ? fmt::format("{:.2f}", *c.ratio.ratio) : "-",
            c.mean ? fmt::format("{:.{}f}", *c.mean * table.metric->shown_factor, table.metric->decimals)
                   : "-",
            fmt::format("{}/{}", c.n_ok, c.n_total)},
           c.complete() ? "" : "warning"});
    }
  }
  std::string text;
  for (const aggregate::BestGroup& group : table.groups) text += group.headline + " ";
  std::erase(text, '`');  // of Markdown
  return {"Best configurations", text + "fusebench best has more of them, and other metrics.",
          std::move(page), 3};
}

/// The charts of the first metric are open, as many as fit on two screens; those of others are folded.
void add_metric(std::vector<page::PageSection>& sections, std::span<const aggregate::RunRow> rows,
                const registry::RunMetric& metric, bool first) {
  constexpr std::size_t kMostOpen = 8;
  const aggregate::SweepEffects effects =
      aggregate::sweep_effects(aggregate::with_binned_options(rows), metric);
  std::vector<page::Chart> effects_open = effect_charts(effects);
  std::vector<page::Chart> effects_folded;
  if (effects_open.size() > kMostOpen) {
    const auto rest = effects_open.begin() + kMostOpen;
    effects_folded.assign(std::make_move_iterator(rest), std::make_move_iterator(effects_open.end()));
    effects_open.erase(rest, effects_open.end());
  }
  add(sections, fmt::format("What each option does to {}", metric.heading),
      "Ratio to the mean of the same recording and variant: below 1 is better. A curve is free of the other "
      "options only where each value met the same values of those. Options with many values are put together "
      "by "
      "neighbours.",
      std::move(effects_open), !first);
  add(sections, fmt::format("Further options, {}", metric.heading), "", std::move(effects_folded), true);
  add(sections, fmt::format("Options in pairs, {}", metric.heading), "Parallel curves do not interact.",
      interaction_charts(effects), true);
  std::vector<page::Chart> pareto;
  if (const aggregate::ParetoFront front = aggregate::pareto_front(rows, metric); !front.points.empty())
    pareto.push_back(pareto_chart(front));
  add(sections, fmt::format("{} against time", metric.heading),
      "Each dot is a configuration; nothing is both better and cheaper than those on the line.",
      std::move(pareto), !first);
}

}  // namespace

std::vector<page::PageSection> sweep_sections(std::span<const aggregate::RunRow> rows) {
  const auto kind_of = aggregate::recording_kinds(rows);
  std::map<std::string, std::vector<aggregate::RunRow>> by_kind;
  for (const aggregate::RunRow& row : rows) by_kind[kind_of.at(row.recording)].push_back(row);
  std::vector<page::PageSection> sections;
  for (const auto& [kind, runs] : by_kind) {
    if (!is_swept(runs)) continue;
    const std::string title = by_kind.size() > 1 ? fmt::format("Sweep ({})", kind) : "Sweep";
    std::vector<page::PageSection> parts;
    std::size_t shown = 0;
    for (const std::string_view name : kMetrics) {
      const auto metric = registry::find_ranking_metric(name);
      if (!metric || !has(runs, **metric) || shown == kMostMetrics) continue;
      if (shown++ == 0) {
        const auto best = aggregate::best_configurations(runs, {*metric, "none", 10});
        if (best) parts.push_back(best_section(*best));
      }
      add_metric(parts, runs, **metric, shown == 1);
    }
    if (parts.empty()) continue;
    parts.front().title = title + ": " + parts.front().title;
    parts.front().level = 2;
    for (page::PageSection& part : parts) sections.push_back(std::move(part));
  }
  return sections;
}

}  // namespace fusebench::report
