#include "core/base/io/text_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <system_error>

#include "core/base/io/input_file.hpp"
#include "core/base/io/row_text.hpp"
#include "core/base/printable.hpp"

namespace fusebench::io {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool is_separator(char c) { return c == ',' || is_blank(c); }

/// Takes the next field away; quotes around it are no part of it, and separators between them are.
std::string_view take_field(std::string_view& rest) {
  const std::size_t quote = rest.starts_with('"') ? rest.find('"', 1) : std::string_view::npos;
  const bool quoted =
      quote != std::string_view::npos && (quote + 1 == rest.size() || is_separator(rest[quote + 1]));
  const auto end = static_cast<std::size_t>(std::ranges::find_if(rest, is_separator) - rest.begin());
  const std::string_view field = quoted ? rest.substr(1, quote - 1) : rest.substr(0, end);
  rest.remove_prefix(quoted ? quote + 1 : end);
  return field;
}

/// A parsed decimal number: value = 0.d1 d2 d3 ... * 10^point.
struct Decimal {
  bool negative = false;
  std::string digits;
  int point = 0;
};

bool take_digits(std::string_view& text, std::string& digits) {
  const std::size_t before = digits.size();
  while (!text.empty() && is_digit(text.front())) {
    digits += text.front();
    text.remove_prefix(1);
  }
  return digits.size() > before;
}

bool take_exponent(std::string_view& text, int& exponent) {
  exponent = 0;
  if (text.empty() || (text.front() != 'e' && text.front() != 'E')) return true;
  text.remove_prefix(1);
  const bool plus = !text.empty() && text.front() == '+';
  if (plus) text.remove_prefix(1);
  if (plus && text.starts_with('-')) return false;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), exponent);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return error == std::errc() && exponent >= -1000 && exponent <= 1000;
}

bool take_decimal(std::string_view text, Decimal& decimal) {
  if (!text.empty() && (text.front() == '-' || text.front() == '+')) {
    decimal.negative = text.front() == '-';
    text.remove_prefix(1);
  }
  const bool whole = take_digits(text, decimal.digits);
  decimal.point = static_cast<int>(decimal.digits.size());
  bool fraction = false;
  if (!text.empty() && text.front() == '.') {
    text.remove_prefix(1);
    fraction = take_digits(text, decimal.digits);
  }
  int exponent = 0;
  if (!(whole || fraction) || !take_exponent(text, exponent) || !text.empty()) return false;
  decimal.point += exponent;
  return true;
}

/// Half of the range, so that the difference of any two times fits as well.
constexpr std::int64_t kMaxTime_ns = std::numeric_limits<std::int64_t>::max() / 2;

/// value = value * 10 + digit, false beyond the latest time.
bool append_digit(std::int64_t& value, int digit) {
  if (value > (kMaxTime_ns - digit) / 10) return false;
  value = value * 10 + digit;
  return true;
}

}  // namespace

std::string_view to_string(TimeUnit unit) {
  switch (unit) {
    case TimeUnit::nanoseconds:
      return "nanoseconds";
    case TimeUnit::microseconds:
      return "microseconds";
    case TimeUnit::milliseconds:
      return "milliseconds";
    case TimeUnit::seconds:
      break;
  }
  return "seconds";
}

Result<std::int64_t> parse_time_ns(std::string_view text, TimeUnit unit) {
  const int decimals = static_cast<int>(unit);
  Decimal decimal;
  if (text.size() > 256 || !take_decimal(text, decimal)) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("expected a time in decimal {}, got '{}'", to_string(unit), printable(text)));
  }
  const auto digit = [&](int i) {
    return i >= 0 && i < static_cast<int>(decimal.digits.size())
               ? decimal.digits[static_cast<std::size_t>(i)] - '0'
               : 0;
  };
  const int kept = decimal.point + decimals;  // digits before the nanosecond's end; negative for tiny numbers
  std::int64_t value = 0;
  bool fits = true;
  for (int i = 0; i < kept && fits; ++i) fits = append_digit(value, digit(i));
  if (fits && digit(kept) >= 5) fits = value++ < kMaxTime_ns;
  if (!fits) {
    return fail(ErrorCode::data_corrupt,
                fmt::format("time '{}' in {} is beyond 146 years (half of the range of 64-bit nanoseconds)",
                            printable(text), to_string(unit)),
                fmt::format("times are {} here; is the file in another unit?", to_string(unit)));
  }
  return decimal.negative ? -value : value;
}

Result<double> parse_number(std::string_view text) {
  const std::string_view unsigned_text = text.starts_with('+') ? text.substr(1) : text;
  double value = 0;
  const auto [end, error] =
      std::from_chars(unsigned_text.data(), unsigned_text.data() + unsigned_text.size(), value);
  const bool whole = end == unsigned_text.data() + unsigned_text.size();
  const bool two_signs = text.starts_with('+') && unsigned_text.starts_with('-');
  if (error != std::errc() || !whole || two_signs || !std::isfinite(value)) {
    return fail(ErrorCode::data_corrupt, fmt::format("expected a finite number, got '{}'", printable(text)));
  }
  return value;
}

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::string_view rest = trim(line);
  if (rest.empty()) return;
  while (true) {
    fields.push_back(take_field(rest));
    if (rest.empty()) return;
    while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
    if (!rest.empty() && rest.front() == ',') {
      rest.remove_prefix(1);
      while (!rest.empty() && is_blank(rest.front())) rest.remove_prefix(1);
      if (rest.empty() && !fields.back().empty()) return;
    }
  }
}

TextTable::TextTable(std::filesystem::path file, std::string_view columns, std::ifstream stream)
    : file_(std::move(file)), stream_(std::move(stream)) {
  std::vector<std::string_view> names;
  split_fields(columns, names);
  more_columns_ = !names.empty() && names.back() == "...";
  if (more_columns_) names.pop_back();
  needed_columns_ = names.size();
  for (std::string_view name : names) {
    if (name.starts_with('[')) {
      needed_columns_ = columns_.size();
      name.remove_prefix(1);
    }
    if (name.ends_with(']')) name.remove_suffix(1);
    columns_.emplace_back(name);
  }
}

Result<TextTable> TextTable::open(const std::filesystem::path& file, std::string_view columns) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such file", file.string()));
  }
  std::ifstream stream = input_file(file);
  if (!stream || std::filesystem::is_directory(file, ignored)) {
    return fail(ErrorCode::data_missing, fmt::format("{}: cannot be read as a file", file.string()));
  }
  return TextTable(file, columns, std::move(stream));
}

tl::unexpected<Error> TextTable::fail_here(std::string_view what, std::string hint) const {
  return fail(ErrorCode::data_corrupt, fmt::format("{}:{}: {}", file_.string(), line_, printable(what, 500)),
              std::move(hint));
}

bool TextTable::has_expected_columns() const {
  const std::size_t columns = fields_.size();
  if (!more_columns_) return columns == columns_.size() || columns == needed_columns_;
  if (text_.find('\r') != std::string_view::npos) return false;  // several rows in one line
  return row_columns_ == 0 ? columns >= needed_columns_ : columns == row_columns_;
}

std::string TextTable::hint_about_row() const {
  if (text_.find('\r') != std::string_view::npos) return "lines must end with a line feed";
  if (has_decimal_commas(text_)) return std::string(kDecimalCommaHint);
  if (text_.find(';') != std::string_view::npos)
    return "columns are separated by blanks or commas: replace the semicolons";
  if (line_ == first_row_line_ && is_line_of_names(fields_))
    return fmt::format("is line {} a line of names? Put # before it", line_);
  return {};
}

tl::unexpected<Error> TextTable::fail_in(std::size_t column, const Error& error) const {
  const std::string hint = hint_about_row();
  return fail_here(fmt::format("{}: {}", columns_[column], error.message), hint.empty() ? error.hint : hint);
}

std::string TextTable::expectation() const {
  if (more_columns_ && row_columns_ == 0)
    return fmt::format("{} columns or more: {}", columns_.size(), fmt::join(columns_, " "));
  if (more_columns_ && row_columns_ > columns_.size())
    return fmt::format("{} columns as in line {}: {} ...", row_columns_, first_row_line_,
                       fmt::join(columns_, " "));
  if (needed_columns_ < columns_.size()) {
    return fmt::format("{} or {} columns: {}", needed_columns_, columns_.size(), fmt::join(columns_, " "));
  }
  return fmt::format("{} columns: {}", columns_.size(), fmt::join(columns_, " "));
}

Result<bool> TextTable::read_line() {
  buffer_.resize(kMaxLineLength + 1);  // getline() also writes a terminator
  stream_.getline(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  const auto count = static_cast<std::size_t>(stream_.gcount());
  if (stream_.bad()) return fail(ErrorCode::data_corrupt, fmt::format("{}: read error", file_.string()));
  if (stream_.fail()) {
    if (count == 0) return false;  // end of the file
    ++line_;
    return fail_here(
        fmt::format("line is longer than {} characters; expected {}", kMaxLineLength, expectation()));
  }
  ++line_;
  // gcount() includes the line feed that getline() took away, which the last line may lack.
  text_ = std::string_view(buffer_).substr(0, stream_.eof() ? count : count - 1);
  if (line_ == 1 && text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  return true;
}

Result<bool> TextTable::next() {
  while (true) {
    const Result<bool> got = read_line();
    if (!got) return tl::unexpected(got.error());
    if (!*got) return false;
    text_ = trim(text_);
    if (text_.find('\0') != std::string_view::npos) {
      return fail_here("not a text file (zero byte)", "tables are UTF-8 or ASCII text");
    }
    split_fields(text_, fields_);
    if (fields_.empty() || fields_.front().starts_with('#') || line_ == left_out_line_) continue;
    if (first_row_line_ == 0) first_row_line_ = line_;
    if (!has_expected_columns())
      return fail_here(fmt::format("expected {}, got {}", expectation(), fields_.size()), hint_about_row());
    row_columns_ = fields_.size();
    return true;
  }
}

Result<std::int64_t> TextTable::time_ns(std::size_t column, TimeUnit unit) const {
  const Result<std::int64_t> value = parse_time_ns(text(column), unit);
  if (!value) return fail_in(column, value.error());
  return value;
}

Result<double> TextTable::number(std::size_t column) const {
  const Result<double> value = parse_number(text(column));
  if (!value) return fail_in(column, value.error());
  return value;
}

Result<void> TextTable::numbers(std::size_t first_column, std::span<double> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Result<double> value = number(first_column + i);
    if (!value) return tl::unexpected(value.error());
    values[i] = *value;
  }
  return {};
}

void TextTable::warn_of_more_columns(std::vector<std::string>& warnings,
                                     std::optional<std::size_t> used) const {
  const std::size_t first = used.value_or(columns_.size());
  if (size() > first)
    warnings.push_back(fmt::format("{}:{}: {} columns after the first {} are not used", file_.string(), line_,
                                   size() - first, first));
}

}  // namespace fusebench::io
