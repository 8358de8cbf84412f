#include "eval/tables/latex_table.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fusebench::tables {

namespace {

/// Letters beside each other that can be read in a column, over both, and along a page (\scriptsize).
std::size_t room_of(const LatexLayout& layout) {
  if (layout.rotated) return 190;
  return layout.columns == 1 ? 70 : 145;
}

std::size_t width_of(const LatexTable& table, std::size_t column) {
  constexpr std::size_t kBetween = 2;
  std::size_t width = table.heading[column].size();
  for (const LatexTable::Line& line : table.lines) width = std::max(width, line.cells[column].size());
  return width + kBetween;
}

/// The columns of numbers of each part.
std::vector<std::vector<std::size_t>> parts_of(const LatexTable& table, std::size_t room) {
  constexpr std::size_t kLeastNumbers = 3;  // of a part, also where the names alone are too wide
  std::size_t names = 0;
  for (std::size_t column = 0; column < table.text_columns; ++column) names += width_of(table, column);
  std::vector<std::vector<std::size_t>> parts = {{}};
  std::size_t used = names;
  for (std::size_t column = table.text_columns; column < table.heading.size(); ++column) {
    const std::size_t width = width_of(table, column);
    if (used + width > room && parts.back().size() >= kLeastNumbers) {
      parts.emplace_back();
      used = names;
    }
    parts.back().push_back(column);
    used += width;
  }
  return parts;
}

text::TableCells chosen(const text::TableCells& cells, const std::vector<std::size_t>& columns) {
  text::TableCells result;
  for (const std::size_t column : columns) result.push_back(cells[column]);
  return result;
}

std::string tabular(const LatexTable& table, const std::vector<std::size_t>& numbers) {
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < table.text_columns; ++column) columns.push_back(column);
  columns.insert(columns.end(), numbers.begin(), numbers.end());
  std::string text = text::latex_begin(chosen(table.heading, columns), table.text_columns);
  text.erase(0, text.find('\n') + 1);  // the packages are named once, for all parts
  for (const LatexTable::Line& line : table.lines) {
    std::vector<std::size_t> bold;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (std::ranges::find(line.bold, columns[i]) != line.bold.end()) bold.push_back(i);
    }
    if (line.rule_before) text += "\\midrule\n";
    text += text::latex_line(chosen(line.cells, columns), bold);
  }
  return "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n" + text +
         std::string(text::kLatexEnd) + "}\n";
}

}  // namespace

std::string latex_table(const LatexTable& table, const LatexLayout& layout) {
  const std::string environment =
      std::string(layout.rotated ? "sidewaystable" : "table") + (layout.columns == 2 ? "*" : "");
  std::string text = fmt::format(
      "% requires \\usepackage{{booktabs}} \\usepackage{{graphicx}}{}\n\\begin{{{}}}\n\\centering\n"
      "\\caption{{{}}}\n\\label{{tab:{}}}\n\\scriptsize\n\\setlength{{\\tabcolsep}}{{3pt}}\n",
      layout.rotated ? " \\usepackage{rotating}" : "", environment, text::latex_escaped(table.caption),
      table.label);
  const auto parts = parts_of(table, room_of(layout));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += "\\par\\medskip\n";
    text += tabular(table, parts[i]);
  }
  if (!table.footnotes.empty()) {
    text += "\\par\\smallskip\n\\begin{minipage}{\\linewidth}\\raggedright\n";
    for (const std::string& footnote : table.footnotes) text += text::latex_escaped(footnote) + "\\par\n";
    text += "\\end{minipage}\n";
  }
  return text + fmt::format("\\end{{{}}}\n", environment);
}

}  // namespace fusebench::tables
