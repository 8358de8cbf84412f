#include <fmt/format.h>

#include <limits>

#include "core/printable.hpp"
#include "eval/compare/comparison_formats.hpp"
#include "eval/report/markup_text.hpp"
#include "eval/report/plain_table.hpp"

namespace fusebench {

namespace {

/// Text that stays text: no tags, no emphasis, no links, no mentions. '|' is left to the table.
std::string escaped(std::string_view text) {
  std::string plain;
  for (const char c : printable(text, std::numeric_limits<std::size_t>::max())) {
    if (std::string_view("\\`*[]").find(c) != std::string_view::npos) plain += '\\';
    plain += c;
  }
  return with_entities(plain, "&<>@");
}

}  // namespace

std::string comparison_markdown(const RunComparison& comparison, bool all) {
  std::string text =
      fmt::format("### fusebench compare\n\n**{}**\n", escaped(comparison_summary(comparison)));
  std::vector<TableCells> cells = {{"verdict", "run", "gate", "what changed"}};
  for (const ComparisonLine& line : comparison_lines(comparison, all)) {
    cells.push_back(
        {std::string(to_string(line.verdict)), escaped(line.run), escaped(line.gate), escaped(line.message)});
  }
  if (cells.size() > 1) text += fmt::format("\n{}", markdown_table(cells, cells.front().size()));
  const std::vector<std::string> remarks = comparison_remarks(comparison);
  if (!remarks.empty()) text += "\n";
  for (const std::string& remark : remarks) text += fmt::format("- {}\n", escaped(remark));
  if (!all) text += fmt::format("\nUnchanged gates: {}.\n", comparison.count(GateVerdict::unchanged));
  return text;
}

}  // namespace fusebench
