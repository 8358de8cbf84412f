// Text tables and the ways in which such files are malformed.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "tests/support/temporary_folder.hpp"

namespace fusebench::testing {

/// A refusal is one short printable line that begins with the file (and the line, if there is one) and says
/// what was expected; `part` is some of that.
inline void expect_refusal(const Error& error, const std::filesystem::path& file, int line,
                           std::string_view part) {
  const std::string place = line > 0 ? fmt::format("{}:{}: ", file.string(), line) : file.string() + ":";
  EXPECT_TRUE(error.message.starts_with(place)) << "expected " << place << "\ngot " << error.message;
  EXPECT_NE(error.message.find(part), std::string::npos) << "expected " << part << "\ngot " << error.message;
  EXPECT_TRUE(std::ranges::all_of(error.message, [](char c) { return c >= ' ' && c <= '~'; }))
      << error.message;
  EXPECT_LT(error.message.size(), 700U);
  EXPECT_NE(exit_code(error.code), exit_code(ErrorCode::internal));
}

using Rows = std::vector<std::string>;  ///< of a table, columns separated by single blanks

inline std::string joined(const Rows& rows, std::string_view end = "\n") {
  std::string text;
  for (const std::string& row : rows) text += row + std::string(end);
  return text;
}

inline std::string replaced(std::string_view text, std::string_view from, std::string_view to) {
  std::string result;
  for (std::size_t at = text.find(from); at != text.npos; at = text.find(from)) {
    result += text.substr(0, at);
    result += to;
    text.remove_prefix(at + from.size());
  }
  return result += text;
}

/// The row with one field replaced; columns count from 0.
inline std::string with_field(const std::string& row, std::size_t column, std::string_view field) {
  std::size_t begin = 0;
  for (; column > 0; --column) begin = row.find(' ', begin) + 1;
  const std::size_t end = std::min(row.find(' ', begin), row.size());
  return row.substr(0, begin) + std::string(field) + row.substr(end);
}

inline Rows with_row(Rows rows, std::size_t index, std::string row) {
  rows[index] = std::move(row);
  return rows;
}

inline std::string utf16(std::string_view text, bool big_endian) {
  std::string wide = big_endian ? "\xFE\xFF" : "\xFF\xFE";
  for (const char c : text) wide += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
  return wide;
}

struct Malformation {
  const char* name;
  std::function<std::string(const Rows& rows)> text;
  int line = 0;           ///< that the error names; 0: the file alone
  const char* part = "";  ///< of the error; empty: the file is read as if it were well-formed
};

/// For any table with a time in column 0 and five rows. The comment takes line 1.
inline std::vector<Malformation> unusual_but_sound() {
  const std::string comment = "# a comment\n";
  return {
      {"CRLF", [](const Rows& r) { return joined(r, "\r\n"); }},
      {"byte order mark", [=](const Rows& r) { return "\xEF\xBB\xBF" + comment + joined(r); }},
      {"byte order mark, no comment", [](const Rows& r) { return "\xEF\xBB\xBF" + joined(r, "\r\n"); }},
      {"tabs", [](const Rows& r) { return replaced(joined(r), " ", "\t"); }},
      {"commas", [](const Rows& r) { return replaced(joined(r), " ", ","); }},
      {"commas and blanks", [](const Rows& r) { return replaced(joined(r), " ", " ,\t"); }},
      {"many blanks", [](const Rows& r) { return replaced(joined(r), " ", " \t  "); }},
      {"blanks at the ends", [](const Rows& r) { return "  " + joined(r, " \t \n   "); }},
      {"blank lines", [](const Rows& r) { return "\n\r\n" + joined(r, "\n\n \t\n"); }},
      {"comments between", [](const Rows& r) { return joined(r, "\n#1 2 3\n  # nan\n"); }},
      {"last line without end", [](const Rows& r) { return joined(r).substr(0, joined(r).size() - 1); }},
      {"no comment", [](const Rows& r) { return joined(r); }},
      {"commas at the ends", [](const Rows& r) { return replaced(joined(r, ",\n"), " ", ","); }},
      {"long comment", [](const Rows& r) { return "#" + std::string(60'000, 'x') + "\n" + joined(r); }},
  };
}

inline std::vector<Malformation> malformed_tables() {
  const auto row_1 = [](auto edit) {
    return [edit](const Rows& r) { return "# a comment\n" + joined(with_row(r, 1, edit(r[1]))); };
  };
  const auto text = [](std::string content) { return [content](const Rows&) { return content; }; };
  return {
      {"empty", text(""), 0, "rows"},
      {"only comments", text("# a\n# b\n"), 0, "rows"},
      {"only blank lines", text("\n \r\n\t\n"), 0, "rows"},
      {"carriage returns alone", [](const Rows& r) { return joined(r, "\r"); }, 1, "columns"},
      {"UTF-16, little-endian", [](const Rows& r) { return utf16(joined(r), false); }, 1, "not a text file"},
      {"UTF-16, big-endian", [](const Rows& r) { return utf16(joined(r), true); }, 1, "not a text file"},
      {"a zero byte", row_1([](std::string row) { return row + '\0'; }), 3, "zero byte"},
      {"a lacking column", row_1([](std::string row) { return row.substr(0, row.rfind(' ')); }), 3,
       "columns"},
      {"one column", row_1([](std::string row) { return row.substr(0, row.find(' ')); }), 3, "got 1"},
      {"an extra column", row_1([](std::string row) { return row + " 7"; }), 3, "columns"},
      {"an empty field", row_1([](std::string row) { return replaced(row, " ", ",,"); }), 3, "columns"},
      {"semicolons", row_1([](std::string row) { return replaced(row, " ", ";"); }), 3, "got 1"},
      {"half a row", [](const Rows& r) { return joined(r) + r[4].substr(0, 3); }, 6, "got 1"},
      {"bytes of another file", row_1([](std::string) { return "\x89PNG\x1A\xFF\xFE"; }), 3, "columns"},
      {"a long line", row_1([](std::string row) { return row + std::string(1'000'000, ' '); }), 3,
       "longer than"},
      {"a long word", row_1([](std::string) { return std::string(1'000'000, '1'); }), 3, "longer than"},
  };
}

/// Words that are no time, no number.
inline std::vector<std::string> not_numbers() {
  return {"nan",
          "-nan",
          "inf",
          "Infinity",
          "0x10",
          "1.2.3",
          "--1",
          "+-1",
          "1e",
          "noon",
          "1O",
          "'1'",
          "1e999",
          "\xE2\x88\x92"
          "1",
          "\xFF\x80",
          std::string(400, '9'),
          std::string(300, 'z')};
}

}  // namespace fusebench::testing
