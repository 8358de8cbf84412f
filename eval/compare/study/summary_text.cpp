#include <fmt/format.h>

#include <algorithm>

#include "eval/compare/study/summary_formats.hpp"

namespace fusebench::study {

namespace {

/// Aligned for a terminal.
std::string markdown(const SummaryTable& table) {
  std::vector<std::size_t> widths;
  for (const std::string& cell : table.header) widths.push_back(std::max<std::size_t>(cell.size(), 3));
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto line_of = [&](const std::vector<std::string>& cells) {
    std::string line = "|";
    for (std::size_t i = 0; i < cells.size(); ++i) line += fmt::format(" {:<{}} |", cells[i], widths[i]);
    return line + "\n";
  };
  std::string text = fmt::format("## {}\n\n{}|", table.title, line_of(table.header));
  for (const std::size_t width : widths) text += fmt::format(" {:-<{}} |", "", width);
  text += "\n";
  for (const auto& row : table.rows) text += line_of(row);
  return text + "\n";
}

}  // namespace

std::string criteria_verdict(const std::vector<CriterionResult>& criteria) {
  const auto count = [&](Verdict verdict) {
    return std::count_if(criteria.begin(), criteria.end(),
                         [&](const CriterionResult& result) { return result.decided.verdict == verdict; });
  };
  return fmt::format(
      "{} of {} criteria passed ({} by less than their noise: a tie), {} failed, {} not decided.",
      count(Verdict::passed) + count(Verdict::tied), criteria.size(), count(Verdict::tied),
      count(Verdict::failed), count(Verdict::not_applicable));
}

std::string criteria_text(const std::vector<CriterionResult>& criteria) {
  return markdown(criteria_table(criteria)) + criteria_verdict(criteria) + "\n\n";
}

std::string summary_text(const StudySummary& summary) {
  std::string text;
  for (const SummaryTable& table : value_tables(summary)) text += markdown(table);
  for (const SummaryTable& table : motion_tables(summary)) text += markdown(table);
  for (const std::string& note : summary.notes) text += fmt::format("- {}\n", note);
  if (!summary.criteria.empty()) text += criteria_text(summary.criteria);
  return text;
}

}  // namespace fusebench::study
