#include "eval/text/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fusebench::text {

std::string aligned_columns(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()), 0);
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      text += i + 1 == line.size() ? line[i] : fmt::format("{:<{}}  ", line[i], widths[i]);
    }
    text += "\n";
  }
  return text;
}

std::string seven_digits(double value) { return fmt::format("{:.7g}", value); }

std::string markdown_cell(std::string_view text) {
  std::string cell;
  for (const char c : text) {
    if (c == '|') cell += '\\';
    cell += c;
  }
  return cell;
}

std::string duration_text(double time_s) {
  if (time_s < 90) return fmt::format("{:.0f} s", time_s);
  if (time_s < 5400) return fmt::format("{:.0f} min", time_s / 60);
  return fmt::format("{:.1f} h", time_s / 3600);
}

}  // namespace fusebench::text
