// A table as a float of a paper, that fits its columns.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

/// Where a table stands in a paper.
struct LatexLayout {
  int columns = 2;                        ///< of a two-column paper that it may cover: 1 or 2
  bool rotated = false;                   ///< by a quarter turn, on a page of its own
  std::vector<std::string> metrics = {};  ///< keys of the numbers of a table of runs; empty: all
};

struct LatexTable {
  struct Line {
    text::TableCells cells;
    std::vector<std::size_t> bold = {};  ///< places of cells
    bool rule_before = false;
  };
  std::string caption;
  std::string label;  ///< for \ref, in letters and '-'
  text::TableCells heading;
  std::size_t text_columns = 1;  ///< left-aligned, and repeated in each part of a table that is split
  std::vector<Line> lines;
  std::vector<std::string> footnotes;  ///< printed below it
};

/// The cells of these columns, and which of them are bold.
[[nodiscard]] LatexTable::Line chosen(const LatexTable::Line& line, const std::vector<std::size_t>& columns);

/// A table, table* or sidewaystable with caption and label, needing the packages that its first line names.
/// What is too wide is split: the columns of numbers over several tabulars, one below the other. Each is
/// scaled down where its letters are wider than was thought. What is too long for a page becomes several
/// floats of one number, the later ones "(continued)"; footnotes are below the last. Texts are escaped.
[[nodiscard]] std::string latex_table(const LatexTable& table, const LatexLayout& layout);

}  // namespace fusebench::tables
