// Strict reader of text tables: rows of columns separated by white space or commas.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench::io {

/// In which unit a file counts time. The value is the number of decimals that a nanosecond takes.
enum class TimeUnit { nanoseconds = 0, microseconds = 3, milliseconds = 6, seconds = 9 };
[[nodiscard]] std::string_view to_string(TimeUnit unit);  ///< "microseconds"

/// Decimal time ("1305031229.528748", "1.5e-3") to integer nanoseconds in integer arithmetic, so that no
/// digit is lost to a double. Digits beyond the nanosecond round to nearest, halves away from zero. Error
/// data_corrupt: not a decimal number, or beyond half the range of int64 nanoseconds (about 146 years), so
/// that differences of times fit, too.
[[nodiscard]] Result<std::int64_t> parse_time_ns(std::string_view text, TimeUnit unit = TimeUnit::seconds);

/// A finite decimal number; the whole text must be one. Error data_corrupt: anything else, also "nan" and
/// "inf".
[[nodiscard]] Result<double> parse_number(std::string_view text);

/// Splits at white space and commas: white space with at most one comma in it is one separator, so "1, 2" has
/// two fields and "1,,2" three. White space at the ends does not count, nor does one comma after the last
/// value: "1,2," has two fields, and "1,," three. Quotes around a field are no part of it.
void split_fields(std::string_view line, std::vector<std::string_view>& fields);

/// Reads one table row by row; only one line is in memory. A byte order mark, carriage returns, blank lines
/// and comments (a first field that begins with '#') are skipped. Every row must have exactly the named
/// columns. The last ones may stand in brackets ("timestamp gx gy gz [ax ay az]"): a row may then do without
/// all of these. After
/// "..." as the last name ("timestamp tx ty tz ...") rows may have more columns, all rows as many.
class TextTable {
 public:
  static constexpr std::size_t kMaxLineLength = 1 << 16;  ///< characters; a longer line is not a table

  /// columns: names, separated by blanks ("timestamp filename"). Errors: data_missing.
  [[nodiscard]] static Result<TextTable> open(const std::filesystem::path& file, std::string_view columns);

  /// A line that is no row, such as names of the columns without '#' before them. Counts from 1.
  void leave_out_line(int line) { left_out_line_ = line; }

  /// Moves to the next row; false at the end of the file. Errors: data_corrupt (number of columns, a line
  /// that is too long, bytes that are not text).
  [[nodiscard]] Result<bool> next();

  /// Of the current row. Columns count from 0. Errors: data_corrupt.
  [[nodiscard]] int line() const { return line_; }
  [[nodiscard]] std::string_view text(std::size_t column) const { return fields_[column]; }
  [[nodiscard]] std::size_t size() const { return fields_.size(); }  ///< number of columns
  [[nodiscard]] bool has(std::size_t column) const { return column < fields_.size(); }
  [[nodiscard]] bool has_commas() const { return text_.find(',') != std::string_view::npos; }
  [[nodiscard]] Result<std::int64_t> time_ns(std::size_t column, TimeUnit unit = TimeUnit::seconds) const;
  [[nodiscard]] Result<double> number(std::size_t column) const;
  /// Fills values from as many neighbouring columns.
  [[nodiscard]] Result<void> numbers(std::size_t first_column, std::span<double> values) const;

  /// Adds a warning, "file:line: 3 columns after the first 8 are not used", if the current row has more than
  /// `used` columns; without `used`, more than the named ones.
  void warn_of_more_columns(std::vector<std::string>& warnings, std::optional<std::size_t> used = {}) const;

  /// An error about the current row: "file:line: what", where `what` may quote the row (see printable.hpp).
  [[nodiscard]] tl::unexpected<Error> fail_here(std::string_view what, std::string hint = {}) const;

 private:
  TextTable(std::filesystem::path file, std::string_view columns, std::ifstream stream);
  [[nodiscard]] Result<bool> read_line();
  [[nodiscard]] bool has_expected_columns() const;
  [[nodiscard]] std::string expectation() const;
  [[nodiscard]] std::string hint_about_row() const;
  [[nodiscard]] tl::unexpected<Error> fail_in(std::size_t column, const Error& error) const;

  std::filesystem::path file_;
  std::vector<std::string> columns_;
  std::size_t needed_columns_ = 0;
  bool more_columns_ = false;    ///< rows may have more than the named ones
  std::size_t row_columns_ = 0;  ///< of the first row
  int first_row_line_ = 0;
  int left_out_line_ = 0;
  std::ifstream stream_;
  std::string buffer_;
  std::string_view text_;  ///< the current line within buffer_
  std::vector<std::string_view> fields_;
  int line_ = 0;
};

}  // namespace fusebench::io
