#include "eval/compare/tables/latex_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

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

/// Lines of \\scriptsize on a page, with a margin for the styles of journals.
std::size_t lines_of_page(const LatexLayout& layout) { return layout.rotated ? 42 : 70; }

/// The lines of each float, so that all parts of the table with these lines fit on a page; split where the
/// table has a rule, if it can be.
std::vector<std::span<const LatexTable::Line>> floats_of(const LatexTable& table, std::size_t parts,
                                                         const LatexLayout& layout) {
  constexpr std::size_t kOfHeading = 4;
  const std::size_t room = std::max<std::size_t>(lines_of_page(layout) / parts, kOfHeading + 6) - kOfHeading;
  std::vector<std::span<const LatexTable::Line>> floats;
  std::span<const LatexTable::Line> left(table.lines);
  while (left.size() > room) {
    std::size_t end = room;
    while (end > 0 && !left[end].rule_before) --end;
    if (end == 0) end = room;
    floats.push_back(left.first(end));
    left = left.subspan(end);
  }
  floats.push_back(left);
  return floats;
}

std::string tabular(const LatexTable& table, std::span<const LatexTable::Line> lines,
                    const std::vector<std::size_t>& numbers) {
  std::vector<std::size_t> columns;
  for (std::size_t column = 0; column < table.text_columns; ++column) columns.push_back(column);
  columns.insert(columns.end(), numbers.begin(), numbers.end());
  std::string text = text::latex_begin(chosen({table.heading}, columns).cells, table.text_columns);
  text.erase(0, text.find('\n') + 1);  // the packages are named once, for all parts
  for (const LatexTable::Line& line : lines) {
    if (line.rule_before && &line != lines.data()) text += "\\midrule\n";
    const LatexTable::Line part = chosen(line, columns);
    text += text::latex_line(part.cells, part.bold);
  }
  return "\\resizebox{\\ifdim\\width>\\linewidth\\linewidth\\else\\width\\fi}{!}{%\n" + text +
         std::string(text::kLatexEnd) + "}\n";
}

std::string footnotes_of(const LatexTable& table) {
  if (table.footnotes.empty()) return "";
  std::string text = "\\par\\smallskip\n\\begin{minipage}{\\linewidth}\\raggedright\n";
  for (std::string footnote : table.footnotes) {
    std::erase(footnote, '`');  // of Markdown; LaTeX sets it as a quotation mark
    text += text::latex_escaped(footnote) + "\\par\n";
  }
  return text + "\\end{minipage}\n";
}

}  // namespace

LatexTable::Line chosen(const LatexTable::Line& line, const std::vector<std::size_t>& columns) {
  LatexTable::Line result{{}, {}, line.rule_before};
  for (const std::size_t column : columns) {
    if (std::ranges::find(line.bold, column) != line.bold.end()) result.bold.push_back(result.cells.size());
    result.cells.push_back(line.cells[column]);
  }
  return result;
}

std::string latex_table(const LatexTable& table, const LatexLayout& layout) {
  const std::string environment =
      std::string(layout.rotated ? "sidewaystable" : "table") + (layout.columns == 2 ? "*" : "");
  const auto parts = parts_of(table, room_of(layout));
  const auto floats = floats_of(table, parts.size(), layout);
  std::string text = fmt::format("% requires \\usepackage{{booktabs}} \\usepackage{{graphicx}}{}\n",
                                 layout.rotated ? " \\usepackage{rotating}" : "");
  for (std::size_t k = 0; k < floats.size(); ++k) {
    text += fmt::format("\\begin{{{}}}\n\\centering\n", environment);
    // All floats of a table have one number.
    if (k > 0) text += "\\addtocounter{table}{-1}\n";
    text +=
        fmt::format("\\caption{{{}{}}}\n", text::latex_escaped(table.caption), k > 0 ? " (continued)" : "");
    if (k == 0) text += fmt::format("\\label{{tab:{}}}\n", table.label);
    text += "\\smallskip\n\\scriptsize\n\\setlength{\\tabcolsep}{3pt}\n";
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (i > 0) text += "\\par\\medskip\n";
      text += tabular(table, floats[k], parts[i]);
    }
    if (k + 1 == floats.size()) text += footnotes_of(table);
    text += fmt::format("\\end{{{}}}\n", environment);
  }
  return text;
}

}  // namespace fusebench::tables
