// Plain-text tables for terminals.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fusebench {

/// Lines of cells in columns of equal width, two blanks between them; the last column is not padded.
[[nodiscard]] std::string aligned_columns(const std::vector<std::vector<std::string>>& lines);

/// A text as a cell of a Markdown table.
[[nodiscard]] std::string markdown_cell(std::string_view text);

}  // namespace fusebench
