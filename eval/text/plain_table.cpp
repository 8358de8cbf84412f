#include "eval/text/plain_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

#include "eval/text/control_characters.hpp"
#include "eval/text/folded_table.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::text {

namespace {

/// Apostrophes count for nothing, so that those which are part of a text and those which are put before one
/// are told apart.
bool may_be_formula(std::string_view cell) {
  const std::size_t first = cell.find_first_not_of('\'');
  return first != std::string_view::npos &&
         std::string_view("=+-@\t\r").find(cell[first]) != std::string_view::npos;
}

bool is_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc{} && read.ptr == text.data() + text.size();
}

/// A line of the table, and those that its cells go on in.
std::string markdown_line(const TableCells& line, const TableBlock& block, std::size_t text_columns) {
  std::string text;
  for (const TableCells& cells : lines_in_block(line, block)) {
    text += "|";
    for (std::size_t i = 0; i < cells.size(); ++i) {
      text += block.columns[i] < text_columns ? fmt::format(" {:<{}} |", cells[i], block.widths[i])
                                              : fmt::format(" {:>{}} |", cells[i], block.widths[i]);
    }
    text += "\n";
  }
  return text;
}

/// The line below the heading.
std::string markdown_rule(const TableBlock& block, std::size_t text_columns) {
  std::string text = "|";
  for (std::size_t i = 0; i < block.columns.size(); ++i) {
    text += block.columns[i] < text_columns ? fmt::format(" {:-<{}} |", "", block.widths[i])
                                            : fmt::format(" {:->{}}: |", "", block.widths[i] - 1);
  }
  return text + "\n";
}

}  // namespace

std::string number_cell(const std::optional<double>& value, double factor, int decimals) {
  return value ? fmt::format("{:.{}f}", *value * factor, decimals) : "-";
}

std::string markdown_table(const std::vector<TableCells>& lines, std::size_t text_columns,
                           std::size_t width) {
  std::vector<TableCells> escaped = lines;
  for (TableCells& line : escaped) {
    for (std::string& cell : line) cell = markdown_cell(cell);
  }
  // "| a | b |"; the narrowest column that is one is "--:".
  const TableLook look{
      .text_columns = text_columns, .around = 4, .between = 3, .narrowest = 3, .heading_on_one_line = true};
  std::string text;
  for (const TableBlock& block : folded_blocks(escaped, look, width)) {
    if (!text.empty()) text += "\n";
    text += markdown_line(escaped.front(), block, text_columns);
    text += markdown_rule(block, text_columns);
    for (std::size_t k = 1; k < escaped.size(); ++k) text += markdown_line(escaped[k], block, text_columns);
  }
  return text;
}

std::string latex_escaped(std::string_view text) {
  std::string result;
  for (const char c : without_controls(text)) {
    switch (c) {
      case '\\':
        result += "\\textbackslash{}";
        break;
      case '~':
        result += "\\textasciitilde{}";
        break;
      case '^':
        result += "\\textasciicircum{}";
        break;
      default:
        if (std::string_view("_&%#${}").find(c) != std::string_view::npos) result += '\\';
        result += c;
    }
  }
  return result;
}

std::string latex_line(const TableCells& cells, const std::vector<std::size_t>& bold) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const std::string cell = latex_escaped(cells[i]);
    const bool is_bold = std::ranges::find(bold, i) != bold.end();
    line += (i == 0 ? "" : " & ") + (is_bold ? "\\textbf{" + cell + "}" : cell);
  }
  return line + " \\\\\n";
}

std::string latex_begin(const TableCells& heading, std::size_t text_columns) {
  return fmt::format("% requires \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{}{}}}\n\\toprule\n",
                     std::string(text_columns, 'l'), std::string(heading.size() - text_columns, 'r')) +
         latex_line(heading) + "\\midrule\n";
}

std::string csv_cell(const std::string& text) {
  const std::string shown = without_controls(text, "\t\r\n");
  const std::string cell = may_be_formula(shown) && !is_number(shown) ? "'" + shown : shown;
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace fusebench::text
