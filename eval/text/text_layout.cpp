#include "eval/text/text_layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace fusebench::text {

namespace {

constexpr std::size_t kGap = 2;
constexpr std::size_t kNarrowest = 12;
constexpr std::size_t kLongestWord = 48;  // what is longer is broken within

std::vector<std::size_t> natural_widths(const std::vector<std::vector<std::string>>& lines) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()), 0);
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  return widths;
}

std::size_t longest_word(std::string_view cell) {
  std::size_t longest = 0;
  while (!cell.empty()) {
    const std::size_t end = std::min(cell.find(' '), cell.size());
    longest = std::max(longest, end);
    cell.remove_prefix(std::min(end + 1, cell.size()));
  }
  return longest;
}

/// Below what a column's words need, it is not made narrower.
std::vector<std::size_t> least_widths(const std::vector<std::vector<std::string>>& lines,
                                      const std::vector<std::size_t>& natural) {
  std::vector<std::size_t> least(natural.size(), kNarrowest);
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i)
      least[i] = std::max(least[i], std::min(longest_word(line[i]), kLongestWord));
  }
  return least;
}

std::vector<std::vector<std::string>> without_controls(std::vector<std::vector<std::string>> lines) {
  for (auto& line : lines) {
    for (std::string& cell : line) cell = text::without_controls(cell);
  }
  return lines;
}

/// The pieces of a cell, each of at most `width` characters.
std::vector<std::string> broken(std::string_view cell, std::size_t width) {
  std::vector<std::string> pieces;
  while (cell.size() > width) {
    const std::size_t blank = cell.rfind(' ', width);
    const bool at_blank = blank != std::string_view::npos && blank > 0;
    pieces.emplace_back(cell.substr(0, at_blank ? blank : width));
    cell.remove_prefix(at_blank ? blank + 1 : width);
  }
  pieces.emplace_back(cell);
  return pieces;
}

}  // namespace

std::string without_controls(std::string_view text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
    // Those of ASCII, and those that are C2 80 to C2 9F in UTF-8.
    if (byte < 0x20 || byte == 0x7F) {
      shown += fmt::format("\\x{:02X}", byte);
    } else if (byte == 0xC2 && next >= 0x80 && next <= 0x9F) {
      shown += fmt::format("\\x{:02X}\\x{:02X}", byte, next);
      ++i;
    } else {
      shown += text[i];
    }
  }
  return shown;
}

std::string aligned_columns(const std::vector<std::vector<std::string>>& given) {
  const std::vector<std::vector<std::string>> lines = without_controls(given);
  const std::vector<std::size_t> widths = natural_widths(lines);
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
  const std::vector<std::vector<std::string>> lines = without_controls(given);
  std::vector<std::size_t> widths = natural_widths(lines);
  const auto total = [&] {
    std::size_t sum = widths.empty() ? 0 : kGap * (widths.size() - 1);
    for (const std::size_t w : widths) sum += w;
    return sum;
  };
  const std::vector<std::size_t> least = least_widths(lines, widths);
  while (total() > width) {
    std::optional<std::size_t> widest;
    for (std::size_t i = 0; i < widths.size(); ++i) {
      if (widths[i] > least[i] && (!widest || widths[i] > widths[*widest])) widest = i;
    }
    if (!widest) break;
    --widths[*widest];
  }
  std::vector<std::vector<std::string>> fitted;
  for (const auto& line : lines) {
    const std::size_t first = fitted.size();
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::vector<std::string> pieces = broken(line[i], std::max<std::size_t>(widths[i], 1));
      while (fitted.size() < first + pieces.size()) fitted.emplace_back(line.size());
      for (std::size_t k = 0; k < pieces.size(); ++k) fitted[first + k][i] = pieces[k];
    }
  }
  std::string text;
  for (const auto& line : fitted) {
    std::string row;
    for (std::size_t i = 0; i < line.size(); ++i) row += fmt::format("{:<{}}", line[i], widths[i] + kGap);
    row.erase(row.find_last_not_of(' ') + 1);
    text += row + "\n";
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
