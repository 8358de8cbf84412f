#include "eval/text/text_layout.hpp"

#include <fmt/format.h>

#include <limits>

#include "eval/text/control_characters.hpp"
#include "eval/text/folded_table.hpp"

namespace fusebench::text {

namespace {

constexpr std::size_t kGap = 2;

std::vector<std::vector<std::string>> without_controls(std::vector<std::vector<std::string>> lines) {
  for (auto& line : lines) {
    for (std::string& cell : line) cell = text::without_controls(cell);
  }
  return lines;
}

}  // namespace

std::string aligned_columns(const std::vector<std::vector<std::string>>& given) {
  const std::vector<std::vector<std::string>> lines = without_controls(given);
  const std::vector<std::size_t> widths = folded_blocks(lines, {}, 0).front().widths;
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      text += i + 1 == line.size() ? line[i] : fmt::format("{:<{}}  ", line[i], widths[i]);
    }
    text += "\n";
  }
  return text;
}

std::string fitted_columns(const std::vector<std::vector<std::string>>& given, std::size_t width) {
  if (width == 0) return aligned_columns(given);
  const std::vector<std::vector<std::string>> lines = without_controls(given);
  const TableLook look{.text_columns = std::numeric_limits<std::size_t>::max(), .between = kGap};
  std::string text;
  for (const TableBlock& block : folded_blocks(lines, look, width)) {
    if (!text.empty()) text += "\n";
    for (const auto& given_line : lines) {
      for (const auto& line : lines_in_block(given_line, block)) {
        std::string row;
        for (std::size_t i = 0; i < line.size(); ++i)
          row += fmt::format("{:<{}}", line[i], block.widths[i] + kGap);
        row.erase(row.find_last_not_of(' ') + 1);
        text += row + "\n";
      }
    }
  }
  return text;
}

std::string seven_digits(double value) { return fmt::format("{:.7g}", value); }

std::string markdown_cell(std::string_view text) {
  std::string cell;
  for (const char c : without_controls(text)) {
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
