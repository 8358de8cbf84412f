#include "core/io/row_text.hpp"

#include <algorithm>
#include <string>

#include "core/io/lower_case.hpp"
#include "core/io/text_table.hpp"

namespace fusebench::io {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

bool is_infinite(std::string_view field) {
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  const std::string lower = lower_case(field);
  return lower == "inf" || lower == "infinity";
}

bool has_letter(std::string_view field) { return std::ranges::any_of(field, is_letter); }

/// Also an empty one, and a unit such as "[]".
bool is_name(std::string_view field) {
  const bool printable = std::ranges::all_of(field, [](char c) { return c > ' ' && c <= '~'; });
  const bool has_digit = std::ranges::any_of(field, [](char c) { return c >= '0' && c <= '9'; });
  constexpr std::string_view kBeginsNumbers = "0123456789+-.";
  const bool like_number = has_digit && kBeginsNumbers.find(field.front()) != std::string_view::npos;
  return printable && !like_number && (has_letter(field) || !has_digit) && !is_nan(field) &&
         !is_infinite(field);
}

/// A whole number or one with a comma in place of the point.
bool is_number_with_comma(std::string_view token) {
  std::string number(token);
  const std::size_t comma = number.find(',');
  if (comma == 0 || comma == std::string::npos || comma + 1 == number.size()) return false;
  const auto digit = [](char c) { return c >= '0' && c <= '9'; };
  if (!digit(number[comma - 1]) || !digit(number[comma + 1])) return false;
  number[comma] = '.';
  return number.find(',') == std::string::npos && parse_number(number).has_value();
}

}  // namespace

bool is_line_of_names(std::span<const std::string_view> fields) {
  return std::ranges::count_if(fields, has_letter) >= 2 && std::ranges::all_of(fields, is_name);
}

bool has_decimal_commas(std::string_view line) {
  constexpr std::string_view kSeparators = " \t\r;";
  std::size_t with_comma = 0;
  bool is_first = true;  // a program may write the stamp with a point, by integers
  while (true) {
    const std::size_t begin = line.find_first_not_of(kSeparators);
    if (begin == std::string_view::npos) return with_comma > 0;
    line.remove_prefix(begin);
    const std::string_view token = line.substr(0, line.find_first_of(kSeparators));
    line.remove_prefix(token.size());
    if (token.find(',') != std::string_view::npos) {
      if (!is_number_with_comma(token)) return false;
      ++with_comma;
    } else if (!is_first && token.find('.') != std::string_view::npos && parse_number(token)) {
      return false;
    }
    is_first = false;
  }
}

bool is_nan(std::string_view field) {
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  const std::string lower = lower_case(field.substr(0, 16));
  return lower == "nan" || (lower.starts_with("nan(") && field.ends_with(')'));
}

}  // namespace fusebench::io
