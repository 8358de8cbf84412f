#include "eval/text/plain_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <system_error>

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

}  // namespace

std::string number_cell(const std::optional<double>& value, double factor, int decimals) {
  return value ? fmt::format("{:.{}f}", *value * factor, decimals) : "-";
}

std::string markdown_table(const std::vector<TableCells>& lines, std::size_t text_columns) {
  std::vector<TableCells> escaped = lines;
  std::vector<std::size_t> widths(lines.front().size(), 3);
  for (TableCells& line : escaped) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      line[i] = markdown_cell(line[i]);
      widths[i] = std::max(widths[i], line[i].size());
    }
  }
  std::string text;
  for (std::size_t k = 0; k < escaped.size(); ++k) {
    text += "|";
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += i < text_columns ? fmt::format(" {:<{}} |", escaped[k][i], widths[i])
                               : fmt::format(" {:>{}} |", escaped[k][i], widths[i]);
    }
    text += "\n";
    if (k > 0) continue;
    text += "|";
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += i < text_columns ? fmt::format(" {:-<{}} |", "", widths[i])
                               : fmt::format(" {:->{}}: |", "", widths[i] - 1);
    }
    text += "\n";
  }
  return text;
}

std::string latex_escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
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
  const std::string cell = may_be_formula(text) && !is_number(text) ? "'" + text : text;
  if (cell.find_first_of(",\"\n\r") == std::string::npos) return cell;
  std::string quoted = "\"";
  for (const char c : cell) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

}  // namespace fusebench::text
