#include "eval/text/plain_table.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "eval/text/control_characters.hpp"
#include "eval/text/json_text.hpp"
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

TEST(CsvCell, ShowsControlCharacters) {
  EXPECT_EQ(csv_cell("a\x1b[31mb"), "a\\x1B[31mb");
  EXPECT_EQ(csv_cell("a\xe2\x80\xae"
                     "b"),
            "a\\xE2\\x80\\xAE"
            "b");
}

TEST(WithoutControls, ShowsMarksOfDirection) {
  // U+202A-202E, U+2066-2069, U+200E, U+200F, U+061C.
  for (const std::string mark : {"\xe2\x80\xaa", "\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x81\xa9",
                                 "\xe2\x80\x8e", "\xe2\x80\x8f", "\xd8\x9c"}) {
    const std::string shown = without_controls("desk" + mark + "gnp.exe");
    EXPECT_EQ(shown.find(mark), std::string::npos) << shown;
    EXPECT_TRUE(shown.starts_with("desk\\x")) << shown;
    EXPECT_TRUE(shown.ends_with("gnp.exe")) << shown;
  }
  const std::string others = "\xe2\x80\x93 \xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d \xf0\x9f\x98\x80";
  EXPECT_EQ(without_controls(others), others) << "dashes, Hebrew and other planes stay";
}

TEST(WithoutControls, ShowsBytesThatAreNoText) {
  EXPECT_EQ(without_controls("caf\xe9"), "caf\\xE9");
  EXPECT_EQ(without_controls("\x9b"
                             "31m"),
            "\\x9B"
            "31m");
  EXPECT_EQ(without_controls("\xe2\x80"), "\\xE2\\x80") << "ends within a character";
  EXPECT_EQ(without_controls("\xc0\x9b"), "\\xC0\\x9B") << "too long for its code";
  EXPECT_EQ(without_controls("\xed\xa0\x80"), "\\xED\\xA0\\x80") << "half of a pair of UTF-16";
  EXPECT_EQ(without_controls("a\tb\nc", "\n"),
            "a\\x09"
            "b\nc");
}

TEST(JsonText, EscapesControlCharactersAndKeepsTheText) {
  const std::string name = "a\x1b\x7f\xc2\x9b\xe2\x80\xae\xc3\xbc";
  const std::string text = json_text({{"name", name}}, -1);
  EXPECT_EQ(text, "{\"name\":\"a\\u001b\\u007f\\u009b\\u202e\xc3\xbc\"}");
  EXPECT_EQ(nlohmann::json::parse(text).at("name"), name);
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
