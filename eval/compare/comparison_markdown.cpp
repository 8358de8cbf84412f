#include <fmt/format.h>

#include <limits>

#include "core/base/printable.hpp"
#include "eval/compare/comparison_formats.hpp"
#include "eval/text/markup_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::compare {

namespace {

/// Text that stays text: no tags, no emphasis, no links, no mentions. '|' is left to the table.
std::string markdown_escaped(std::string_view text) {
  std::string plain;
  for (const char c : printable(text, std::numeric_limits<std::size_t>::max())) {
    if (std::string_view("\\`*[]").find(c) != std::string_view::npos) plain += '\\';
    plain += c;
  }
  return text::with_entities(plain, "&<>@");
}

}  // namespace

std::string comparison_markdown(const RunComparison& comparison, bool all) {
  std::string text =
      fmt::format("### fusebench compare\n\n**{}**\n", markdown_escaped(comparison_summary(comparison)));
  std::vector<text::TableCells> cells = {{"verdict", "run", "gate", "what changed"}};
  for (const ComparisonLine& line : comparison_lines(comparison, all)) {
    cells.push_back({std::string(to_string(line.verdict)), markdown_escaped(line.run),
                     markdown_escaped(line.gate), markdown_escaped(line.message)});
  }
  if (cells.size() > 1) text += fmt::format("\n{}", text::markdown_table(cells, cells.front().size()));
  const std::vector<std::string> remarks = comparison_remarks(comparison);
  if (!remarks.empty()) text += "\n";
  for (const std::string& remark : remarks) text += fmt::format("- {}\n", markdown_escaped(remark));
  if (!all) text += fmt::format("\nUnchanged gates: {}.\n", comparison.count(GateVerdict::unchanged));
  return text;
}

}  // namespace fusebench::compare
