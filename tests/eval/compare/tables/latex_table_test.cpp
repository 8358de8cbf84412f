#include "eval/compare/tables/latex_table.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "eval/compare/tables/table.hpp"
#include "eval/text/markup_text.hpp"
#include "tests/eval/compare/tables/folder_of_runs.hpp"
#include "tests/support/collected_table.hpp"

namespace fusebench {

using namespace record;
using namespace tables;

namespace {

using testing::collect_table;

using LatexTableTest = testing::InFolderOfRuns;

TEST_F(LatexTableTest, RunsThatAreShownAlikeAreAllTheBest) {
  add_run("full", RunStatus::ok, "", 0.01231, {});
  add_run("dm", RunStatus::ok, "", 0.01229, {});
  add_run("no-imu", RunStatus::ok, "", 0.02, {});
  const auto table = collect_table(folder_ / "runs");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  const std::string text = render_table(*table, TableFormat::latex);
  std::size_t bold = 0;
  for (auto at = text.find("\\textbf{1.23}"); at != std::string::npos;
       at = text.find("\\textbf{1.23}", at + 1))
    ++bold;
  EXPECT_EQ(bold, 2U) << text;
}

TEST_F(LatexTableTest, FootnotesHaveNoMarkdown) {
  LatexTable table;
  table.heading = {"recording", "ATE [cm]"};
  table.lines = {{{"desk", "1.23"}}};
  table.footnotes = {"`fusebench inspect` looks for the reason"};
  const std::string text = latex_table(table, {});
  EXPECT_NE(text.find("\nfusebench inspect looks"), std::string::npos) << text;
}

TEST_F(LatexTableTest, LatexHasTheBestOfEachRecordingInBold) {
  add_three_runs();
  const std::string text = render_table(*collect_table(folder_ / "runs"), TableFormat::latex);
  EXPECT_NE(text.find("& 6.000 & \\textbf{2.000} & \\textbf{1.23} &"), std::string::npos) << text;
  EXPECT_NE(text.find("& \\textbf{3.000} & 3.000 & 5.00 &"), std::string::npos) << text;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST_F(LatexTableTest, LatexIsAFloatWithCaptionAndPrintedFootnotes) {
  add_three_runs();
  const auto table = collect_table(folder_ / "runs");
  const std::string both = render_table(*table, TableFormat::latex);
  for (const char* const part : {"\\begin{table*}", "\\caption{", "\\label{tab:runs}", "\\end{table*}"})
    EXPECT_NE(both.find(part), std::string::npos) << part;
  // What a comment holds is not printed.
  std::string printed;
  std::istringstream lines(both);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with('%')) printed += line + "\n";
  }
  for (const std::string& footnote : table->footer)
    EXPECT_NE(printed.find(text::latex_escaped(footnote)), std::string::npos) << footnote;
  EXPECT_NE(printed.find("runs ok"), std::string::npos);
  EXPECT_EQ(occurrences(both, "\\begin{"), occurrences(both, "\\end{"));
}

TEST_F(LatexTableTest, LatexOfOneColumnIsSplitAndNamesItsRowsInEachPart) {
  add_three_runs();
  const auto table = collect_table(folder_ / "runs");
  const std::string narrow = render_table(*table, TableFormat::latex, {1, false});
  EXPECT_EQ(narrow.find("table*"), std::string::npos);
  const std::size_t parts = occurrences(narrow, "\\begin{tabular}");
  EXPECT_GT(parts, 1U);
  EXPECT_EQ(occurrences(narrow, "\\end{tabular}"), parts);
  EXPECT_EQ(occurrences(narrow, "fr1\\_rpy & recorded & synthetic IMU & full &"), parts);
  EXPECT_EQ(occurrences(narrow, "\\textbf{1.23}"), 1U)
      << "each number stands once, and bold where it is the best";
  EXPECT_EQ(occurrences(narrow, "\\ifdim\\width>\\linewidth"), parts) << "none is wider than its column";
  const std::string rotated = render_table(*table, TableFormat::latex, {2, true});
  EXPECT_NE(rotated.find("\\begin{sidewaystable*}"), std::string::npos);
  EXPECT_EQ(occurrences(rotated, "\\begin{tabular}"), 1U);
}

TEST(LatexTable, WhatIsLongerThanAPageIsSeveralFloatsOfOneNumber) {
  LatexTable table;
  table.caption = "Runs";
  table.label = "runs";
  table.heading = {"recording", "a"};
  table.footnotes = {"said once"};
  for (int i = 0; i < 150; ++i)
    table.lines.push_back({.cells = {fmt::format("r{:03}", i), "1"}, .rule_before = i % 10 == 0});
  const std::string text = latex_table(table, {});
  EXPECT_EQ(occurrences(text, "\\begin{table*}"), 3U);
  EXPECT_EQ(occurrences(text, "\\end{table*}"), 3U);
  EXPECT_EQ(occurrences(text, " (continued)}"), 2U);
  EXPECT_EQ(occurrences(text, "\\addtocounter{table}{-1}"), 2U);
  EXPECT_EQ(occurrences(text, "\\label{"), 1U);
  EXPECT_EQ(occurrences(text, "said once"), 1U);
  for (int i = 0; i < 150; ++i) EXPECT_EQ(occurrences(text, fmt::format("r{:03} &", i)), 1U) << i;
  // Recordings stay together.
  for (std::size_t at = text.find("\\end{table*}"); at != std::string::npos;
       at = text.find("\\end{table*}", at + 1)) {
    const std::size_t last = text.rfind("r", text.rfind(" & 1", at));
    EXPECT_EQ(text[last + 3], '9') << text.substr(last, 4);
  }
}

TEST_F(LatexTableTest, LatexEscapesNames) {
  add_three_runs();
  const std::string text = render_table(*collect_table(folder_ / "runs"), TableFormat::latex);
  EXPECT_NE(text.find("fr1\\_rpy & recorded & synthetic IMU & full & ok"), std::string::npos) << text;
  EXPECT_NE(text.find("\\toprule"), std::string::npos);
}

}  // namespace
}  // namespace fusebench
