#include "core/base/io/row_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "core/base/io/lower_case.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/printable.hpp"

namespace fusebench::io {

namespace {

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// The beginning of a number or word.
std::string unsigned_lower_case(std::string_view field) {
  if (field.starts_with('-') || field.starts_with('+')) field.remove_prefix(1);
  return lower_case(field.substr(0, 16));
}

bool has_letter(std::string_view field) { return std::ranges::any_of(field, is_letter); }

/// Also an empty one, and a unit such as "[]".
bool is_name(std::string_view field) {
  const bool printable = std::ranges::all_of(field, [](char c) { return c > ' ' && c <= '~'; });
  const bool has_digit = std::ranges::any_of(field, [](char c) { return c >= '0' && c <= '9'; });
  constexpr std::string_view kBeginsNumbers = "0123456789+-.";
  const bool like_number = has_digit && kBeginsNumbers.find(field.front()) != std::string_view::npos;
  return printable && !like_number && (has_letter(field) || !has_digit) &&
         (field.empty() || !is_missing(field)) && !is_infinite(field);
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

bool has_numbers_with_comma(std::string_view line) {
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

/// "0,55,-0,05": whole numbers, of which one after the first begins with a zero.
bool has_numbers_split_at_comma(std::string_view line) {
  constexpr std::string_view kDigits = "0123456789";
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  bool has_zeros = false;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view digits = fields[i].substr(fields[i].starts_with('-') ? 1 : 0);
    if (digits.empty() || digits.find_first_not_of(kDigits) != std::string_view::npos) return false;
    has_zeros = has_zeros || (i > 0 && digits.size() > 1 && digits.front() == '0');
  }
  return has_zeros && line.find(',') != std::string_view::npos;
}

/// Brackets belong to the name before them.
std::vector<std::string> split_at_blanks(std::string_view text) {
  std::vector<std::string> names;
  int depth = 0;
  bool begins = true;
  for (const char c : text) {
    const bool opens = c == '[' || c == '(' || c == '{';
    if (depth == 0 && (c == ' ' || c == '\t' || c == '\r')) {
      begins = true;
      continue;
    }
    if (begins && !(opens && !names.empty())) names.emplace_back();
    if (begins && opens && !names.empty() && !names.back().empty()) names.back() += ' ';
    begins = false;
    if (opens) ++depth;
    if (c == ']' || c == ')' || c == '}') depth = std::max(0, depth - 1);
    names.back() += c;
  }
  return names;
}

std::string_view without(std::string_view text, std::string_view characters) {
  const std::size_t begin = text.find_first_not_of(characters);
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(characters) + 1 - begin);
}

}  // namespace

bool is_line_of_names(std::span<const std::string_view> fields) {
  return std::ranges::count_if(fields, has_letter) >= 2 && std::ranges::all_of(fields, is_name);
}

std::vector<std::string> column_names(std::string_view line) {
  constexpr std::string_view kBlanks = " \t\r\"'";
  if (line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
  line = without(line, kBlanks);
  line.remove_prefix(std::min(line.find_first_not_of("#% \t"), line.size()));
  const std::size_t comma = std::min(line.find(','), line.size());
  if (const std::size_t colon = line.find(':'); colon < comma) line.remove_prefix(colon + 1);
  if (line.find(',') == line.npos) return split_at_blanks(line);
  std::vector<std::string> names;
  while (true) {
    const std::string_view name = line.substr(0, line.find(','));
    names.emplace_back(without(name, kBlanks));
    if (name.size() == line.size()) break;
    line.remove_prefix(name.size() + 1);
  }
  if (names.back().empty()) names.pop_back();
  return names;
}

std::string as_columns(std::span<const std::string> names) {
  std::string columns;
  for (std::size_t column = 0; column < names.size(); ++column) {
    std::string name = printable(names[column].substr(0, names[column].find_first_of("[({")));
    std::erase_if(name, [](char c) { return c == ' ' || c == ','; });
    columns += fmt::format("{}{}", column == 0 ? "" : " ",
                           name.empty() ? fmt::format("column_{}", column + 1) : name);
  }
  return columns;
}

bool has_decimal_commas(std::string_view line) {
  std::vector<std::string_view> fields;
  split_fields(line, fields);
  if (std::ranges::any_of(fields, is_number_with_comma)) return true;  // "0,55" in quotes
  std::string text(line);
  std::erase(text, '"');
  return has_numbers_with_comma(text) || has_numbers_split_at_comma(text);
}

bool is_missing(std::string_view field) {
  constexpr std::array<std::string_view, 6> kWords = {"", "nan", "null", "none", "na", "n/a"};
  const std::string lower = unsigned_lower_case(field);
  return std::ranges::find(kWords, lower) != kWords.end() || lower.starts_with("1.#ind") ||
         lower.starts_with("1.#qnan") || lower.starts_with("1.#snan") ||
         (lower.starts_with("nan(") && field.ends_with(')'));
}

bool is_infinite(std::string_view field) {
  const std::string lower = unsigned_lower_case(field);
  return lower == "inf" || lower == "infinity" || lower.starts_with("1.#inf");
}

}  // namespace fusebench::io
