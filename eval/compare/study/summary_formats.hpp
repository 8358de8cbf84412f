// A study's summary as a document to keep, as tables for a terminal, and as a page.
#pragma once

#include <string>

#include "eval/compare/study/study.hpp"
#include "eval/compare/study/study_summary.hpp"

namespace fusebench::study {

/// How a summary was made, so that its numbers can be repeated and two summaries can be told apart.
struct SummaryOrigin {
  std::string command = {};              ///< that repeats it, without folders of the machine
  std::vector<std::string> absent = {};  ///< what the suite left out, as BatchPlan::absent
};

/// JSON in SI units with keys in a fixed order: origin (with the versions and machines of the records, and
/// the UTC date of the newest), rows, curves, criteria, and every run. No times but frames a second; numbers
/// that do not exist are null.
[[nodiscard]] std::string summary_json(const StudySummary& summary, const Study& study,
                                       const SummaryOrigin& origin = {});

/// Markdown: the criteria, then a table a split, then AIE against motion.
[[nodiscard]] std::string summary_text(const StudySummary& summary);
/// How many criteria passed, in a sentence.
[[nodiscard]] std::string criteria_verdict(const std::vector<CriterionResult>& criteria);
/// The criteria alone.
[[nodiscard]] std::string criteria_text(const std::vector<CriterionResult>& criteria);

/// One HTML file that needs no network: the same tables, and charts.
[[nodiscard]] std::string summary_page(const StudySummary& summary, const Study& study);

/// Cells that the text and the page share.
struct SummaryTable {
  std::string title;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};
[[nodiscard]] SummaryTable criteria_table(const std::vector<CriterionResult>& criteria);
/// Mean, median and worst of the trajectory, AIE and model; then NEES. Empty tables are left out.
[[nodiscard]] std::vector<SummaryTable> value_tables(const StudySummary& summary);
[[nodiscard]] std::vector<SummaryTable> motion_tables(const StudySummary& summary);

}  // namespace fusebench::study
