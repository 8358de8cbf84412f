#include "eval/text/plain_table.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "eval/text/text_layout.hpp"

namespace fusebench::text {

namespace {

TEST(CsvCell, IsQuotedWhereItMustBe) {
  EXPECT_EQ(csv_cell("desk"), "desk");
  EXPECT_EQ(csv_cell("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_cell("6\" lens"), "\"6\"\" lens\"");
  EXPECT_EQ(csv_cell("two\nlines"), "\"two\nlines\"");
}

TEST(CsvCell, IsNoFormulaForASpreadsheet) {
  EXPECT_EQ(csv_cell("=HYPERLINK(1)"), "'=HYPERLINK(1)");
  EXPECT_EQ(csv_cell("@SUM(A1)"), "'@SUM(A1)");
  EXPECT_EQ(csv_cell("+cmd"), "'+cmd");
  EXPECT_EQ(csv_cell("-1+1"), "'-1+1");
  EXPECT_EQ(csv_cell("=a,b"), "\"'=a,b\"");
  EXPECT_EQ(csv_cell("\t=1"), "'\t=1");
}

TEST(CsvCell, NumbersStayNumbers) {
  for (const char* number : {"-0.5", "+3", "-1e-9", "-inf", "0", "12.25"})
    EXPECT_EQ(csv_cell(number), number);
}

TEST(CsvCell, TellsTextsApart) {
  const std::vector<std::string> texts = {"",     "desk",  "=1",     "'=1", "''=1",
                                          "-0.5", "'-0.5", "'desk'", "'",   "-"};
  std::set<std::string> cells;
  for (const std::string& text : texts) cells.insert(csv_cell(text));
  EXPECT_EQ(cells.size(), texts.size());
  EXPECT_EQ(csv_cell("'=1"), "''=1");
  EXPECT_EQ(csv_cell("'desk'"), "'desk'");
}

TEST(Tables, ShowControlCharactersInsteadOfObeyingThem) {
  const std::string name = "fr1\x1b[2J\r\n\x7f\xc2\x9b";
  const std::string shown = "fr1\\x1B[2J\\x0D\\x0A\\x7F\\xC2\\x9B";
  EXPECT_EQ(without_controls(name), shown);
  EXPECT_EQ(without_controls("B\xc3\xbcro \xe5\xae\xa4"), "B\xc3\xbcro \xe5\xae\xa4") << "UTF-8 stays";
  EXPECT_EQ(aligned_columns({{name, "b"}}), shown + "  b\n");
  EXPECT_EQ(fitted_columns({{name, "b"}}, 200), shown + "  b\n");
  EXPECT_NE(markdown_table({{"recording"}, {name}}, 1).find("| " + shown + " |"), std::string::npos);
}

}  // namespace
}  // namespace fusebench::text
