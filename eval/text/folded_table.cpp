#include "eval/text/folded_table.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

namespace fusebench::text {

namespace {

using Lines = std::vector<std::vector<std::string>>;

constexpr std::size_t kNarrowestText = 12;
constexpr std::size_t kLongestWord = 48;    // what is longer is broken even where words are kept whole
constexpr std::size_t kShortestPiece = 16;  // of a word that is broken

enum class Words { whole, broken };

std::vector<std::size_t> natural_widths(const Lines& lines, const TableLook& look) {
  std::vector<std::size_t> widths;
  for (const auto& line : lines) {
    widths.resize(std::max(widths.size(), line.size()), look.narrowest);
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

/// Below what its words need, a column of text is not made narrower.
std::size_t least_width(const Lines& lines, const TableLook& look, std::size_t column, Words words) {
  std::size_t least = std::max(look.narrowest, kNarrowestText);
  const std::size_t longest = words == Words::whole ? kLongestWord : kShortestPiece;
  for (const auto& line : lines) {
    if (column >= line.size()) continue;
    const bool unbroken = look.heading_on_one_line && &line == &lines.front();
    least = std::max(least, unbroken ? line[column].size() : std::min(longest_word(line[column]), longest));
  }
  return least;
}

std::size_t line_width(const TableBlock& block, const TableLook& look) {
  std::size_t sum = look.around + look.between * (block.widths.empty() ? 0 : block.widths.size() - 1);
  for (const std::size_t width : block.widths) sum += width;
  return sum;
}

/// The widest columns of text become narrower, as far as needed and as their words allow it.
TableBlock narrowed(TableBlock block, const Lines& lines, const TableLook& look, std::size_t width,
                    Words words) {
  std::vector<std::size_t> least = block.widths;
  for (std::size_t i = 0; i < block.columns.size(); ++i) {
    if (block.columns[i] < look.text_columns) least[i] = least_width(lines, look, block.columns[i], words);
  }
  while (line_width(block, look) > width) {
    std::optional<std::size_t> widest;
    for (std::size_t i = 0; i < least.size(); ++i) {
      if (block.widths[i] > least[i] && (!widest || block.widths[i] > block.widths[*widest])) widest = i;
    }
    if (!widest) break;
    --block.widths[*widest];
  }
  return block;
}

/// As narrow as is needed, without broken words if that is enough.
TableBlock fitted(const TableBlock& block, const Lines& lines, const TableLook& look, std::size_t width) {
  TableBlock whole = narrowed(block, lines, look, width, Words::whole);
  return line_width(whole, look) <= width ? whole : narrowed(block, lines, look, width, Words::broken);
}

std::size_t different_rows(const Lines& lines, const std::vector<std::size_t>& columns) {
  std::set<std::vector<std::string_view>> rows;
  for (const auto& line : lines) {
    std::vector<std::string_view> row;
    for (const std::size_t column : columns)
      row.push_back(column < line.size() ? std::string_view(line[column]) : std::string_view());
    rows.insert(std::move(row));
  }
  return rows.size();
}

/// The first column, and then those of text that tell most of the rows apart which it does not.
std::vector<std::size_t> key_columns(const Lines& lines, std::size_t text_columns) {
  std::vector<std::size_t> keys = {0};
  std::size_t told = different_rows(lines, keys);
  while (told < lines.size()) {
    std::optional<std::size_t> best;
    for (std::size_t column = 1; column < text_columns; ++column) {
      keys.push_back(column);
      if (const std::size_t more = different_rows(lines, keys); more > told) {
        told = more;
        best = column;
      }
      keys.pop_back();
    }
    if (!best) break;
    keys.push_back(*best);
  }
  return keys;
}

/// A column beside the keys of its block: narrower than it is only if a line has no room for it.
std::size_t width_beside(const Lines& lines, const TableLook& look, std::size_t column, std::size_t natural,
                         std::size_t room) {
  if (natural <= room) return natural;
  std::size_t least = least_width(lines, look, column, Words::whole);
  if (least > room && column < look.text_columns) least = least_width(lines, look, column, Words::broken);
  return std::min(natural, std::max(room, least));
}

/// The columns that each block begins with, in half of the width where words allow it. Two thirds are the
/// most that several may have: the last ones are then not repeated, and rows are told apart by their order.
TableBlock key_block(const Lines& lines, const TableLook& look, const std::vector<std::size_t>& natural,
                     std::size_t width) {
  std::vector<std::size_t> keys = key_columns(lines, std::min(look.text_columns, natural.size()));
  for (;; keys.pop_back()) {
    TableBlock block{keys, {}};
    std::ranges::sort(block.columns);
    for (const std::size_t column : block.columns) block.widths.push_back(natural[column]);
    block = fitted(block, lines, look, width / 2);
    if (keys.size() == 1 || line_width(block, look) <= 2 * width / 3) return block;
  }
}

std::vector<TableBlock> split(const Lines& lines, const TableLook& look,
                              const std::vector<std::size_t>& natural, std::size_t width) {
  const TableBlock keys = key_block(lines, look, natural, width);
  const std::size_t taken = line_width(keys, look) + look.between;
  std::vector<TableBlock> blocks;
  for (std::size_t column = 0; column < natural.size(); ++column) {
    if (std::ranges::find(keys.columns, column) != keys.columns.end()) continue;
    const std::size_t needed =
        width_beside(lines, look, column, natural[column], width > taken ? width - taken : 1);
    if (blocks.empty() || line_width(blocks.back(), look) + look.between + needed > width)
      blocks.push_back(keys);
    blocks.back().columns.push_back(column);
    blocks.back().widths.push_back(needed);
  }
  return blocks.empty() ? std::vector<TableBlock>{keys} : blocks;
}

/// How much of a text that is longer goes into a line of `width` characters, blanks apart.
std::size_t piece_length(std::string_view cell, std::size_t width) {
  const std::size_t blank = cell.rfind(' ', width);
  if (blank != std::string_view::npos && blank > 0) return blank;
  for (const char* const marks : {"/_-=,:", "."}) {
    const std::size_t mark = cell.substr(0, width).find_last_of(marks);
    if (mark != std::string_view::npos && mark >= width / 3) return mark + 1;
  }
  std::size_t end = width;
  // No letter of UTF-8 is cut, nor what a backslash stands before.
  while (end > 1 && ((static_cast<unsigned char>(cell[end]) & 0xC0U) == 0x80U || cell[end - 1] == '\\'))
    --end;
  return end;
}

/// The pieces of a cell, each of at most `width` characters.
std::vector<std::string> broken(std::string_view cell, std::size_t width) {
  std::vector<std::string> pieces;
  while (cell.size() > width) {
    const std::size_t length = piece_length(cell, width);
    pieces.emplace_back(cell.substr(0, length));
    cell.remove_prefix(cell[length] == ' ' ? length + 1 : length);
  }
  pieces.emplace_back(cell);
  return pieces;
}

}  // namespace

std::vector<TableBlock> folded_blocks(const Lines& lines, const TableLook& look, std::size_t width) {
  const std::vector<std::size_t> natural = natural_widths(lines, look);
  TableBlock all{{}, natural};
  for (std::size_t column = 0; column < natural.size(); ++column) all.columns.push_back(column);
  if (width == 0 || natural.empty()) return {all};
  TableBlock block = fitted(all, lines, look, width);
  if (line_width(block, look) <= width) return {block};
  return split(lines, look, natural, width);
}

Lines lines_in_block(const std::vector<std::string>& line, const TableBlock& block) {
  Lines lines(1, std::vector<std::string>(block.columns.size()));
  for (std::size_t i = 0; i < block.columns.size(); ++i) {
    if (block.columns[i] >= line.size()) continue;
    const std::vector<std::string> pieces =
        broken(line[block.columns[i]], std::max<std::size_t>(block.widths[i], 1));
    if (lines.size() < pieces.size())
      lines.resize(pieces.size(), std::vector<std::string>(block.columns.size()));
    for (std::size_t k = 0; k < pieces.size(); ++k) lines[k][i] = pieces[k];
  }
  return lines;
}

}  // namespace fusebench::text
