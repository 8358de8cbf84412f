#include "eval/report/summary_sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "eval/compare/findings/findings.hpp"
#include "eval/compare/findings/ranking.hpp"
#include "eval/compare/tables/systems_table.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/report/overview_section.hpp"

namespace fusebench::report {

namespace {

constexpr std::size_t kMostCompared = 20;  // configurations; of a sweep's the best

page::PageTable page_table(const tables::ResultTable& table) {
  page::PageTable page;
  const auto lines = tables::table_cells(table);
  page.header = lines.front();
  page.sortable = true;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const record::RunStatus status =
        i <= table.rows.size() ? table.rows[i - 1].status : record::RunStatus::ok;
    page.rows.push_back({lines[i], status == record::RunStatus::failed ? "error"
                                   : status == record::RunStatus::lost ? "warning"
                                                                       : ""});
    page.rows.back().fixed = i > table.rows.size();  // a mean
    if (i <= table.rows.size()) page.rows.back().best = tables::best_cells(table, table.rows[i - 1]);
  }
  return page;
}

page::PageTable lines_table(const std::vector<std::string>& lines) {
  page::PageTable table;
  for (std::string line : lines) {
    std::erase(line, '`');  // of Markdown
    table.rows.push_back({{std::move(line)}, ""});
  }
  return table;
}

page::PageSection findings_section(const std::vector<run_files::FoundRun>& runs,
                                   const tables::ResultTable& table,
                                   const std::vector<findings::Ranking>& rankings) {
  page::PageParagraphs paragraphs;
  for (const findings::Ranking& ranking : rankings) {
    if (auto sentence = findings::sentence_of(ranking)) paragraphs.lines.push_back(std::move(*sentence));
  }
  if (auto sentence = findings::final_poses_of(runs)) paragraphs.lines.push_back(std::move(*sentence));
  for (std::string& sentence : findings::failures_of(table)) paragraphs.lines.push_back(std::move(sentence));
  paragraphs.lines.push_back(findings::origin_of(runs));
  return {"What was found", "", std::move(paragraphs)};
}

page::PageTable::Row compared_row(const findings::Ranking& ranking,
                                  const findings::RankedConfiguration& configuration) {
  const aggregate::RatioMean& mean = configuration.mean;
  std::string interval = "-";
  if (mean.interval) {
    const auto& [low, high] = *mean.interval;
    interval = fmt::format("{:.2f} to {:.2f}", low, high);
  }
  return {{configuration.label, configuration.description,
           fmt::format("{}/{}", configuration.ok, configuration.runs),
           tables::shown_value(*ranking.metric, configuration.value),
           mean.ratio ? fmt::format("{:.2f}", *mean.ratio) : "-", std::move(interval)},
          configuration.ok < configuration.runs ? "warning" : ""};
}

/// What each configuration is, and how it compares with the best.
page::PageSection compared_section(const findings::Ranking& ranking, bool only) {
  page::PageTable table;
  table.header = {"configuration",  "what it is",   "runs ok", std::string(ranking.metric->heading),
                  "times the best", "95 % interval"};
  const std::size_t count = std::min(ranking.configurations.size(), kMostCompared);
  for (std::size_t i = 0; i < count; ++i)
    table.rows.push_back(compared_row(ranking, ranking.configurations[i]));
  for (page::PageTable::Row& row : table.rows) {
    const bool is_best = row.cells[3] == table.rows.front().cells[3];  // as it is shown
    if (ranking.configurations.front().value && count > 1 && is_best) row.best = {3};
  }
  std::string text = fmt::format(
      "Geometric means over {} {} recording{}; times the best: of the ratio to the smallest number of each "
      "recording, with its interval by bootstrap over recordings and replicates.",
      ranking.recordings, ranking.data_word(), ranking.recordings == 1 ? "" : "s");
  if (count < ranking.configurations.size())
    text += fmt::format(" The first {} of {}.", count, ranking.configurations.size());
  return {only ? "What was compared"
               : fmt::format("What was compared: {} data{}", ranking.data_word(), ranking.restrictions()),
          std::move(text), std::move(table), 3, true};
}

/// The table of systems and how to read it, where it says more than the table of runs.
void add_systems(const std::vector<run_files::FoundRun>& runs, std::vector<page::PageSection>& sections) {
  if (!tables::compares_systems(runs)) return;
  const tables::SystemsTable systems = tables::systems_table_of(runs);
  const auto lines = tables::systems_table_cells(systems);
  page::PageTable table{lines.front(), {}};
  for (std::size_t i = 0; i < systems.rows.size(); ++i) {
    const tables::SystemRow& row = systems.rows[i];
    table.rows.push_back({lines[i + 1], row.runs == 0 ? "note" : row.ok < row.runs ? "warning" : ""});
  }
  table.sortable = true;
  sections.push_back({"Systems", "A row a recording, system and kind of poses.", std::move(table), 2, true});
  std::vector<std::string> remarks = systems.footer;
  remarks.insert(remarks.end(), systems.notes.begin(), systems.notes.end());
  sections.push_back({"How to read the table of systems", "", lines_table(remarks), 3, true});
}

}  // namespace

std::vector<page::PageSection> summary_sections(const std::vector<run_files::FoundRun>& runs,
                                                std::span<const std::string> pictures) {
  const tables::ResultTable table = tables::table_of(runs);
  const std::vector<findings::Ranking> rankings = findings::rankings_of(runs, table);
  std::vector<page::PageSection> sections;
  for (const findings::Ranking& ranking : rankings)
    sections.push_back(overview_section(ranking, table, pictures, rankings.size() == 1));
  sections.push_back(findings_section(runs, table, rankings));
  for (const findings::Ranking& ranking : rankings)
    sections.push_back(compared_section(ranking, rankings.size() == 1));
  const bool revised = std::ranges::any_of(
      runs, [](const run_files::FoundRun& run) { return run.record.final_metrics.has_value(); });
  std::string text = "Green: the smallest of a recording's runs that are ok over the same frames.";
  if (revised) {
    text +=
        " Of runs that revised their poses at the end: the online ones; the final ones are in the table of "
        "systems below.";
  }
  text += " A click on a heading sorts by its column.";
  sections.push_back({"All runs", std::move(text), page_table(table), 2, true});
  std::vector<std::string> remarks = table.footer;
  remarks.insert(remarks.end(), table.notes.begin(), table.notes.end());
  sections.push_back({"How to read the columns", "", lines_table(remarks), 3, true});
  add_systems(runs, sections);
  return sections;
}

}  // namespace fusebench::report
