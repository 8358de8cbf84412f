// Lines of cells as Markdown, LaTeX and CSV.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench::text {

using TableCells = std::vector<std::string>;

/// With so many decimals, times a factor; "-" of what does not exist.
[[nodiscard]] std::string number_cell(const std::optional<double>& value, double factor, int decimals);

/// The first line is the heading; `text_columns` columns are left-aligned, the others right-aligned. Columns
/// are as wide as their longest cell, so that a terminal shows a table, too. With a `width` (characters of a
/// line, 0: any number) that is not enough, the table is folded (folded_table.hpp): cells go on in rows of
/// their own, and blocks of columns are tables, one after the other.
[[nodiscard]] std::string markdown_table(const std::vector<TableCells>& lines, std::size_t text_columns,
                                         std::size_t width = 0);

/// A cell as LaTeX text, without control characters.
[[nodiscard]] std::string latex_escaped(std::string_view text);

/// "a & b \\": cells are escaped; those whose number is in `bold` are set so.
[[nodiscard]] std::string latex_line(const TableCells& cells, const std::vector<std::size_t>& bold = {});

/// The beginning of a tabular, with its heading, as booktabs has it; and its end.
[[nodiscard]] std::string latex_begin(const TableCells& heading, std::size_t text_columns);
inline constexpr std::string_view kLatexEnd = "\\bottomrule\n\\end{tabular}\n";

/// As RFC 4180: quoted where it must be. Without control characters, but for tabs and line breaks. A text
/// that a spreadsheet would take for a formula, since it begins with = + - @, a tab or a carriage return and
/// is no number, stands behind an apostrophe; so does one that begins with apostrophes before such a
/// character, so that a reader can undo it (docs/experiments.md; scripts/python does).
[[nodiscard]] std::string csv_cell(const std::string& text);

}  // namespace fusebench::text
