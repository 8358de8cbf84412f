// A table that is wider than the place where it is shown: long texts go on in the lines below, and what is
// still too wide stands in blocks of columns, one below the other. No column is dropped.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fusebench::text {

/// What a line of a table is made of.
struct TableLook {
  std::size_t text_columns = 0;      ///< the first ones may be broken, others only if nothing else helps
  std::size_t around = 0;            ///< characters of a line before the first cell and after the last one
  std::size_t between = 0;           ///< and between two cells
  std::size_t narrowest = 0;         ///< width of a column that every cell may have
  bool heading_on_one_line = false;  ///< the first line cannot be broken
};

/// Columns that are next to each other, and how wide each is.
struct TableBlock {
  std::vector<std::size_t> columns;
  std::vector<std::size_t> widths;
};

/// One block where lines of at most `width` characters have room for all columns as they are, or with texts
/// broken at blanks, or else within words (after a '/', '_' and the like). Where they have not, several: each
/// begins with the text columns that tell the rows apart (as many of them as leave room for others). A width
/// of 0 has room for everything. A block is wider than `width` only where no break could help.
[[nodiscard]] std::vector<TableBlock> folded_blocks(const std::vector<std::vector<std::string>>& lines,
                                                    const TableLook& look, std::size_t width);

/// A line of the table in a block: the cells of its columns, as many lines as the longest of them needs. A
/// cell that the line does not have is empty.
[[nodiscard]] std::vector<std::vector<std::string>> lines_in_block(const std::vector<std::string>& line,
                                                                   const TableBlock& block);

}  // namespace fusebench::text
