#include "core/base/io/row_text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "core/base/io/text_table.hpp"

namespace fusebench {

using namespace io;

namespace {

bool names(std::string_view line) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  return is_line_of_names(fields);
}

TEST(RowText, LinesOfNamesHaveNoNumbers) {
  for (const char* line :
       {"timestamp tx ty tz qx qy qz qw", "ts (ns),tx (m),ty (m)", "%time,field.header.seq",
        "timestamp [ns], q_RS_w [], q_RS_x []", ",t,x", "\"\",\"t\",\"x\"", "p1 p2"})
    EXPECT_TRUE(names(line)) << line;
  for (const char* line : {"noon 0 0 0", "1 2 3", "nan nan", "inf -inf", "time", "1O 2O", "", "- -",
                           "\x89PNG\x1A x", "0x10 0x11"})
    EXPECT_FALSE(names(line)) << line;
}

TEST(RowText, NamesOfColumns) {
  EXPECT_EQ(column_names("\xEF\xBB\xBF# time [ns], tx (m),,\"q x\","),
            (std::vector<std::string>{"time [ns]", "tx (m)", "", "q x"}));
  EXPECT_EQ(as_columns(column_names("time [ns], tx (m),,q x")), "time tx column_3 qx");
}

TEST(RowText, DecimalCommasAreBetweenDigits) {
  for (const char* line :
       {"1403636579,763556 0,554494 -2,064888", "1.5 0,5 0", "0,5\t1\t1,5e-3", "1,5;2,5;0", "12,5 rgb/1.png"})
    EXPECT_TRUE(has_decimal_commas(line)) << line;
  for (const char* line : {"1, 2, 3", "1 ,2", "1,2,3", "0,5 1.5", "1.0,2.0", "1 2 3", "", "1,", ",5 0"})
    EXPECT_FALSE(has_decimal_commas(line)) << line;
}

TEST(RowText, DecimalCommasBetweenCommas) {
  for (const char* line : {"1403636579,763556,0,554494,-2,064888", "1,5, 0,05", "\"1,5\",\"0,05\"", "5,0,05"})
    EXPECT_TRUE(has_decimal_commas(line)) << line;
  for (const char* line : {"000012,1,0,0,-0", "1,0,00.5", "0,05,x", "0 05", "100,200,10"})
    EXPECT_FALSE(has_decimal_commas(line)) << line;
}

TEST(RowText, MissingNumbersInAllSpellings) {
  for (const char* field : {"", "nan", "NaN", "-nan", "NAN", "nan(ind)", "-nan(snan)", "null", "None", "NA",
                            "n/a", "-1.#IND", "1.#QNAN"})
    EXPECT_TRUE(is_missing(field)) << field;
  for (const char* field : {"nano", "1", "nan(", "nonesuch", "1.", "0", "inf"})
    EXPECT_FALSE(is_missing(field)) << field;
}

TEST(RowText, InfiniteNumbersInAllSpellings) {
  for (const char* field : {"inf", "-Infinity", "+INF", "1.#INF00"}) EXPECT_TRUE(is_infinite(field)) << field;
  for (const char* field : {"", "info", "nan", "1e9"}) EXPECT_FALSE(is_infinite(field)) << field;
}

}  // namespace
}  // namespace fusebench
