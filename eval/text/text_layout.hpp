// Plain-text tables for terminals.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench::text {

/// Lines of cells, without_controls(), in columns of equal width, two blanks between them; the last column is
/// not padded.
[[nodiscard]] std::string aligned_columns(const std::vector<std::vector<std::string>>& lines);

/// aligned_columns() in lines of at most `width` characters (0: any number), folded as in folded_table.hpp.
[[nodiscard]] std::string fitted_columns(const std::vector<std::vector<std::string>>& lines,
                                         std::size_t width);

/// "45 s", "35 min", "2.5 h".
[[nodiscard]] std::string duration_text(double time_s);

/// A number with seven significant digits, "0.01234568".
[[nodiscard]] std::string seven_digits(double value);

/// A text as a cell of a Markdown table, without_controls().
[[nodiscard]] std::string markdown_cell(std::string_view text);

}  // namespace fusebench::text
