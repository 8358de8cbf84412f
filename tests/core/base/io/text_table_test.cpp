#include "core/base/io/text_table.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"

namespace fusebench {

using namespace io;

namespace {

using testing::TemporaryFolder;

struct Rows {
  std::vector<std::vector<std::string>> fields;
  std::vector<int> lines;
  std::string error;
};

Rows read_all(std::string_view content, std::string_view columns) {
  const TemporaryFolder folder;
  auto table = TextTable::open(folder.write("list.txt", content), columns);
  Rows rows;
  if (!table) {
    rows.error = table.error().message;
    return rows;
  }
  while (true) {
    const Result<bool> got = table->next();
    if (!got) rows.error = got.error().message;
    if (!got || !*got) return rows;
    rows.lines.push_back(table->line());
    rows.fields.emplace_back();
    for (std::size_t i = 0; i < 2; ++i) rows.fields.back().emplace_back(table->text(i));
  }
}

using Fields = std::vector<std::vector<std::string>>;

TEST(TextTable, SkipsWhatIsNotARow) {
  const Rows rows = read_all(
      "\xEF\xBB\xBF# comment\r\n\r\n1 a\r\n \t \n  # indented comment\n\t2\t\tb \n3,c\n4 , d", "t name");
  EXPECT_EQ(rows.error, "");
  EXPECT_EQ(rows.fields, (Fields{{"1", "a"}, {"2", "b"}, {"3", "c"}, {"4", "d"}}));
  EXPECT_EQ(rows.lines, (std::vector<int>{3, 6, 7, 8}));
}

TEST(TextTable, ByteOrderMarkBeforeTheFirstRow) {
  EXPECT_EQ(read_all("\xEF\xBB\xBF"
                     "1 a\n",
                     "t name")
                .fields,
            (Fields{{"1", "a"}}));
}

TEST(TextTable, EmptyFilesHaveNoRows) {
  for (const char* content : {"", "\n", "\r\n\r\n", "# only a comment", "\xEF\xBB\xBF"}) {
    const Rows rows = read_all(content, "t name");
    EXPECT_TRUE(rows.fields.empty()) << content;
    EXPECT_EQ(rows.error, "") << content;
  }
}

TEST(TextTable, WrongNumberOfColumnsNamesPlaceAndExpectation) {
  const std::string missing = read_all("# x\n1 a\n2\n", "t name").error;
  EXPECT_NE(missing.find("list.txt:3: expected 2 columns: t name, got 1"), std::string::npos) << missing;
  EXPECT_NE(read_all("1 a b\n", "t name").error.find(":1: expected 2 columns: t name, got 3"),
            std::string::npos);
  EXPECT_NE(read_all("1,,a\n", "t name").error.find("got 3"), std::string::npos) << "an empty field counts";
  EXPECT_NE(read_all("1,a,,\n", "t name").error.find("got 4"), std::string::npos)
      << "so does an empty last one";
}

TEST(TextTable, ACommaAfterTheLastValueIsNoColumn) {
  EXPECT_EQ(read_all("1,a,\n2,b ,\n3,c\n", "t name").fields, (Fields{{"1", "a"}, {"2", "b"}, {"3", "c"}}));
  std::vector<std::string_view> fields;
  split_fields("1,,", fields);
  EXPECT_EQ(fields.size(), 3U) << "values that are missing";
}

TEST(TextTable, QuotesAroundFieldsAreNoPartOfThem) {
  EXPECT_EQ(read_all("\"# t\",\"name\"\n\"1\",\"a b, c\"\n\"2\" \"\"\n3,d\"e\n4,\"f\"g\n", "t name").fields,
            (Fields{{"1", "a b, c"}, {"2", ""}, {"3", "d\"e"}, {"4", "\"f\"g"}}));
}

TEST(TextTable, MoreColumnsWhereTheyAreAllowed) {
  EXPECT_EQ(read_all("1 a x y\n2 b x y\n", "t name ...").fields, (Fields{{"1", "a"}, {"2", "b"}}));
  EXPECT_NE(read_all("1\n", "t name ...").error.find(":1: expected 2 columns or more: t name, got 1"),
            std::string::npos);
  const std::string ragged = read_all("# c\n1 a x\n2 b\n", "t name ...").error;
  EXPECT_NE(ragged.find(":3: expected 3 columns as in line 2: t name ..., got 2"), std::string::npos)
      << ragged;
  EXPECT_NE(read_all("1 a\n2 b x\n", "t name ...").error.find(":2: expected 2 columns: t name, got 3"),
            std::string::npos);
  EXPECT_FALSE(read_all("1 a\r2 b\r3 c", "t name ...").error.empty()) << "several rows in one line";
}

TEST(TextTable, HintsSayWhatIsWrongWithARow) {
  const TemporaryFolder folder;
  const auto hint = [&](std::string_view text) {
    auto table = TextTable::open(folder.write("t.txt", text), "timestamp a b");
    const auto row = table->next();
    if (!row) return row.error().hint;
    const auto time = table->time_ns(0);
    return time ? std::string() : time.error().hint;
  };
  EXPECT_NE(hint("timestamp,a,b\n1,2,3\n").find("Put # before it"), std::string::npos);
  EXPECT_NE(hint("timestamp,a\n1,2,3\n").find("Put # before it"), std::string::npos);
  EXPECT_NE(hint("1,5 2,5 3,5\n").find("decimal comma"), std::string::npos);
  EXPECT_NE(hint("1;2;3\n").find("semicolons"), std::string::npos);
  EXPECT_EQ(hint("1 2 3 4\n"), "");
}

TEST(TextTable, RefusesWhatIsNotText) {
  EXPECT_NE(read_all(std::string_view("1 a\n\0\0 b\n", 9), "t name").error.find(":2: not a text file"),
            std::string::npos);
  const std::string long_line = "1 a\n" + std::string(TextTable::kMaxLineLength + 1, 'x') + "\n";
  EXPECT_NE(read_all(long_line, "t name").error.find(":2: line is longer than 65536"), std::string::npos);
  const std::string longest = "1 " + std::string(TextTable::kMaxLineLength - 2, 'x') + "\n2 b\n";
  EXPECT_EQ(read_all(longest, "t name").fields.size(), 2U);
}

TEST(TextTable, MissingFileAndFolder) {
  const TemporaryFolder folder;
  const auto missing = TextTable::open(folder.path() / "none.txt", "t");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::data_missing);
  EXPECT_NE(missing.error().message.find("none.txt"), std::string::npos);
  const auto a_folder = TextTable::open(folder.path(), "t");
  ASSERT_FALSE(a_folder);
  EXPECT_EQ(a_folder.error().code, ErrorCode::data_missing);
}

TEST(TextTable, ValueErrorsNameFileLineAndColumn) {
  const TemporaryFolder folder;
  auto table = TextTable::open(folder.write("truth.txt", "1 2\nx nan\n"), "timestamp tx");
  ASSERT_TRUE(table && table->next() && table->next());
  const auto time = table->time_ns(0);
  ASSERT_FALSE(time);
  EXPECT_EQ(time.error().code, ErrorCode::data_corrupt);
  EXPECT_NE(time.error().message.find("truth.txt:2: timestamp: expected a time"), std::string::npos)
      << time.error().message;
  const auto number = table->number(1);
  ASSERT_FALSE(number);
  EXPECT_NE(number.error().message.find("truth.txt:2: tx: expected a finite number, got 'nan'"),
            std::string::npos);
}

TEST(TextTable, NumbersOfNeighbouringColumns) {
  const TemporaryFolder folder;
  auto table = TextTable::open(folder.write("t.txt", "1 2 -3 4e1\n1 2 x 4\n"), "t a b c");
  ASSERT_TRUE(table && table->next());
  std::array<double, 3> values{};
  ASSERT_TRUE(table->numbers(1, values));
  EXPECT_EQ(values, (std::array<double, 3>{2, -3, 40}));
  ASSERT_TRUE(table->next());
  const auto refused = table->numbers(1, values);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("t.txt:2: b: expected a finite number"), std::string::npos);
}

TEST(ParseTime, IsExact) {
  struct Case {
    const char* text;
    std::int64_t ns;
  };
  for (const Case& c : {
           Case{"1305031229.528748", 1305031229528748000},
           Case{"1305031229.5287", 1305031229528700000},
           Case{"1305031229", 1305031229000000000},
           Case{"0", 0},
           Case{"-0.000000001", -1},
           Case{"+1.5", 1500000000},
           Case{".25", 250000000},
           Case{"7.", 7000000000},
           Case{"0.123456789", 123456789},
           Case{"0.1234567894999", 123456789},
           Case{"0.1234567895", 123456790},
           Case{"-0.1234567895", -123456790},
           Case{"0.9999999999", 1000000000},
           Case{"0.0000000005", 1},
           Case{"0.00000000049", 0},
           Case{"1.305031229528748000e+09", 1305031229528748000},  // as numpy prints
           Case{"1.5E-3", 1500000},
           Case{"5e-10", 1},
           Case{"5e-11", 0},
           Case{"1e-400", 0},
           Case{"0e1000", 0},
           Case{"4611686018.427387903", 4611686018427387903},
           Case{"-4611686018.427387903", -4611686018427387903},
       }) {
    const auto ns = parse_time_ns(c.text);
    ASSERT_TRUE(ns) << c.text;
    EXPECT_EQ(*ns, c.ns) << c.text;
  }
}

TEST(ParseTime, RefusesEverythingElse) {
  for (const char* text : {"", ".", "-", "e5", "nan", "inf", "1.2.3", "1,5", "0x10", "12s", "1e", "1e+",
                           "1e+-5", "1e-2147483648", "--1", "+-1", "1 2", "1e5000"}) {
    EXPECT_FALSE(parse_time_ns(text)) << text;
  }
  EXPECT_FALSE(parse_time_ns(std::string(300, '1')));
}

TEST(ParseTime, RefusesOverflow) {
  for (const char* text : {"4611686018.427387904", "4611686018.4273879035", "9223372036.854775808",
                           "1305031229528748000", "1e10", "99999999999999999999"}) {
    const auto ns = parse_time_ns(text);
    ASSERT_FALSE(ns) << text;
    EXPECT_NE(ns.error().message.find("64-bit"), std::string::npos) << text;
  }
}

TEST(ParseNumber, FiniteNumbersOnly) {
  EXPECT_EQ(parse_number("0.1").value(), 0.1);
  EXPECT_EQ(parse_number("+2.5e-3").value(), 2.5e-3);
  EXPECT_EQ(parse_number("-7").value(), -7.0);
  for (const char* text :
       {"", "nan", "-nan", "inf", "-Infinity", "1e999", "1.0x", "+-1", "++1", "1,2", " 1"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
}

}  // namespace
}  // namespace fusebench
