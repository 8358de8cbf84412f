#include "eval/text/folded_table.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "eval/text/plain_table.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::text {

namespace {

const std::vector<TableCells> kRuns = {
    {"recording", "data", "variant", "ATE [cm]", "RPE [cm/s]", "AIE common [grey]", "fps"},
    {"rgbd_dataset_freiburg1_xyz", "recorded", "full", "1.25", "1.5", "8.001", "31.5"},
    {"rgbd_dataset_freiburg1_xyz", "recorded", "full tsdf.voxel_m=0.0125 iekf.max_iterations=8", "1.375",
     "1.625", "8.002", "30.25"},
    {"rgbd_dataset_freiburg1_rpy", "recorded", "full", "2.25", "2.5", "9.003", "29.75"}};
constexpr std::size_t kRunTexts = 3;

std::vector<std::string> lines_of_text(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// The cells of a row of Markdown, without the blanks around them.
TableCells cells_of_row(const std::string& row) {
  TableCells cells;
  std::istringstream stream(row.substr(1));
  for (std::string cell; std::getline(stream, cell, '|');) {
    const std::size_t first = cell.find_first_not_of(' ');
    cells.push_back(first == std::string::npos ? ""
                                               : cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
  }
  return cells;
}

/// The tables of a text, each with its rows; blank lines lie between them.
std::vector<std::vector<std::string>> tables_in(const std::string& text) {
  std::vector<std::vector<std::string>> tables(1);
  for (const std::string& line : lines_of_text(text)) {
    if (line.empty()) {
      tables.emplace_back();
    } else {
      tables.back().push_back(line);
    }
  }
  return tables;
}

TEST(FoldedTables, StayAsTheyAreWhereThereIsRoom) {
  const std::string whole = markdown_table(kRuns, kRunTexts);
  EXPECT_EQ(tables_in(whole).size(), 1U);
  EXPECT_EQ(markdown_table(kRuns, kRunTexts, lines_of_text(whole).front().size()), whole);
}

TEST(FoldedTables, BreakTextsBeforeTheySplit) {
  const std::size_t whole = lines_of_text(markdown_table(kRuns, kRunTexts)).front().size();
  const auto tables = tables_in(markdown_table(kRuns, kRunTexts, whole - 10));
  ASSERT_EQ(tables.size(), 1U);
  EXPECT_EQ(tables.front().size(), kRuns.size() + 2) << "the rule, and a line more for the longest name";
  EXPECT_EQ(cells_of_row(tables.front()[4]), (TableCells{"", "", "iekf.max_iterations=8", "", "", "", ""}));
}

TEST(FoldedTables, AreValidTablesOfTheWidthWithEveryCell) {
  for (const std::size_t width : {60U, 80U, 100U}) {
    const std::string text = markdown_table(kRuns, kRunTexts, width);
    std::multiset<std::string> numbers;
    const auto tables = tables_in(text);
    EXPECT_GT(tables.size(), 1U) << width;
    for (const auto& rows : tables) {
      ASSERT_GT(rows.size(), kRuns.size());
      EXPECT_EQ(rows[1].find_first_not_of("|-: "), std::string::npos)
          << "the rule below the heading: " << rows[1];
      for (const std::string& row : rows) {
        EXPECT_LE(row.size(), width) << row;
        EXPECT_EQ(cells_of_row(row).size(), cells_of_row(rows.front()).size()) << row;
        for (const std::string& cell : cells_of_row(row)) numbers.insert(cell);
      }
    }
    for (const TableCells& line : kRuns) {
      for (std::size_t i = kRunTexts; i < line.size(); ++i) EXPECT_EQ(numbers.count(line[i]), 1U) << line[i];
    }
  }
}

TEST(FoldedTables, RepeatInEachBlockWhatTellsTheRowsApart) {
  for (const auto& rows : tables_in(markdown_table(kRuns, kRunTexts, 80))) {
    const TableCells heading = cells_of_row(rows.front());
    EXPECT_EQ(heading[0], "recording");
    EXPECT_EQ(heading[1], "variant") << "the recording has two runs";
    EXPECT_EQ(cells_of_row(rows[2])[1], "full");
  }
}

TEST(FoldedTables, AreAsWideAsTheyMustWhereNothingHelps) {
  for (const std::size_t width : {1U, 20U}) {
    const std::string text = markdown_table(kRuns, kRunTexts, width);
    for (const char* heading : {"| data ", "| ATE [cm] |", "| AIE common [grey] |", " fps |"})
      EXPECT_NE(text.find(heading), std::string::npos) << text;
  }
  EXPECT_NE(markdown_table({{"name", "number"}}, 1, 5).find("number"), std::string::npos);
}

TEST(FoldedTables, CutNoLetterAndNoEscapeInTwo) {
  std::string name, bars;
  for (int i = 0; i < 40; ++i) {
    name += "\xc3\xbc";
    bars += "|";
  }
  const std::string text = markdown_table({{"name", "n"}, {"a" + name, "1"}, {bars, "2"}}, 1, 30);
  std::size_t letters = 0;
  for (const std::string& line : lines_of_text(text)) {
    const std::string cell = cells_of_row(line).front();
    EXPECT_FALSE(cell.starts_with('\xbc')) << line;
    letters += static_cast<std::size_t>(std::ranges::count(line, '\xbc'));
    EXPECT_EQ(line.find("\\ "), std::string::npos) << "a backslash without its bar: " << line;
  }
  EXPECT_EQ(letters, 40U);
}

TEST(FoldedTables, ProseOfRightAlignedColumnsIsBrokenIfItAloneIsTooLong) {
  const std::string note =
      "failed or lost: fr1_rpy fr1_xyz fr2_desk; not run: fr3_office icl_lr_kt2 icl_of_kt3";
  const std::string text = markdown_table({{"variant", "ok", "incomplete"}, {"full", "2/3", note}}, 1, 60);
  for (const std::string& line : lines_of_text(text)) EXPECT_LE(line.size(), 60U) << line;
  EXPECT_NE(text.find("icl_of_kt3"), std::string::npos);
}

TEST(FoldedTables, OfPlainColumnsAreBlocksAsWell) {
  std::vector<std::vector<std::string>> lines(2);
  for (const char* name : {"first", "second", "third", "fourth", "fifth", "sixth"}) {
    lines[0].emplace_back(name);
    lines[1].push_back(std::string(40, name[0]) + name);
  }
  EXPECT_EQ(fitted_columns(lines, 0), aligned_columns(lines));
  const std::string text = fitted_columns(lines, 60);
  EXPECT_GT(tables_in(text).size(), 1U);
  for (const auto& block : tables_in(text)) EXPECT_TRUE(block.front().starts_with("first ")) << block.front();
  for (const std::string& line : lines_of_text(text)) EXPECT_LE(line.size(), 60U) << line;
  for (const std::string& name : lines.front()) EXPECT_NE(text.find(name), std::string::npos) << name;
}

}  // namespace

}  // namespace fusebench::text
