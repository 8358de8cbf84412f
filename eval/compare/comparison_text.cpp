#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "core/base/printable.hpp"
#include "eval/compare/comparison_formats.hpp"
#include "eval/text/text_layout.hpp"

namespace fusebench::compare {

namespace {

constexpr std::array<std::pair<std::string_view, ComparisonFormat>, 7> kFormats = {
    {{"table", ComparisonFormat::table},
     {"markdown", ComparisonFormat::markdown},
     {"json", ComparisonFormat::json},
     {"junit", ComparisonFormat::junit},
     {"gbench", ComparisonFormat::gbench},
     {"github-benchmark", ComparisonFormat::github_benchmark},
     {"openmetrics", ComparisonFormat::openmetrics}}};

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

std::string counted(std::size_t number, std::string_view what) {
  return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
}

bool is_remark(const GateResult& gate) {
  return gate.verdict == GateVerdict::note && (!gate.not_gated.empty() || gate.gate == "trajectory");
}

/// Many runs of one repetition are one sentence: the range of their ratios.
void add_ungated_times(const RunComparison& comparison, std::vector<std::string>& remarks) {
  struct Range {
    std::size_t runs = 0;
    double least = std::numeric_limits<double>::infinity();
    double most = 0;
  };
  std::map<std::pair<std::string, std::string>, Range> ranges;  // by reason, then quantity
  for (const ComparedRun& run : comparison.runs) {
    for (const GateResult& gate : run.gates) {
      if (gate.not_gated.empty() || !gate.base || !gate.fresh) continue;
      Range& range = ranges[{gate.not_gated, gate.gate}];
      ++range.runs;
      range.least = std::min(range.least, *gate.fresh / *gate.base);
      range.most = std::max(range.most, *gate.fresh / *gate.base);
    }
  }
  for (const auto& [key, range] : ranges) {
    const std::string ratios = range.runs == 1
                                   ? fmt::format("ratio {:.3f}", range.least)
                                   : fmt::format("ratios {:.3f} .. {:.3f}", range.least, range.most);
    remarks.push_back(
        fmt::format("{} of {} not gated: {}; {}", key.second, counted(range.runs, "run"), key.first, ratios));
  }
}

}  // namespace

Result<ComparisonFormat> parse_comparison_format(std::string_view text) {
  std::vector<std::string_view> names;
  for (const auto& [name, format] : kFormats) {
    if (name == text) return format;
    names.push_back(name);
  }
  return fail(ErrorCode::usage, fmt::format("--format {} (allowed: {})", text, fmt::join(names, " | ")));
}

std::string render_comparison(const RunComparison& comparison, ComparisonFormat format, bool all,
                              std::size_t width) {
  switch (format) {
    case ComparisonFormat::table:
      return comparison_text(comparison, all, width);
    case ComparisonFormat::markdown:
      return comparison_markdown(comparison, all);
    case ComparisonFormat::json:
      return comparison_json(comparison);
    case ComparisonFormat::junit:
      return comparison_junit(comparison);
    case ComparisonFormat::gbench:
      return comparison_gbench(comparison);
    case ComparisonFormat::github_benchmark:
      return comparison_github_benchmark(comparison);
    case ComparisonFormat::openmetrics:
      return comparison_openmetrics(comparison);
  }
  return {};
}

std::vector<ComparisonLine> comparison_lines(const RunComparison& comparison, bool all) {
  std::vector<ComparisonLine> lines;
  for (const ComparedRun& run : comparison.runs) {
    for (const GateResult& gate : run.gates) {
      if (!all && (gate.verdict == GateVerdict::unchanged || is_remark(gate))) continue;
      std::string message = printable(gate.message, kAll);
      if (message.empty() && gate.fresh) message = quantity_text(*gate.fresh, gate.unit);
      lines.push_back({gate.verdict, printable(run.runs.label, kAll), gate.gate, std::move(message)});
    }
  }
  std::ranges::stable_sort(lines, {}, &ComparisonLine::verdict);
  return lines;
}

std::string comparison_summary(const RunComparison& comparison) {
  return fmt::format(
      "{}: {}, {} changed, {}, {} in {}; trajectories: {} bit-identical, {} different",
      comparison.passed() ? "PASS" : "FAIL", counted(comparison.count(GateVerdict::regression), "regression"),
      comparison.count(GateVerdict::changed),
      counted(comparison.count(GateVerdict::improvement), "improvement"),
      counted(comparison.count(GateVerdict::suspect), "possible slowdown"),
      counted(comparison.runs.size(), "run"), comparison.identical(), comparison.diverging().size());
}

std::vector<std::string> comparison_remarks(const RunComparison& comparison) {
  std::vector<std::string> remarks;
  for (const ComparedRun* run : comparison.diverging())
    remarks.push_back(
        fmt::format("{}: the trajectory {}", printable(run->runs.label, kAll), run->divergence->text()));
  for (const ComparedRun& run : comparison.runs) {
    for (const GateResult& gate : run.gates) {
      if (gate.gate == "trajectory" && gate.verdict == GateVerdict::note && !run.divergence)
        remarks.push_back(fmt::format("{}: {}", printable(run.runs.label, kAll), gate.message));
    }
  }
  add_ungated_times(comparison, remarks);
  for (const std::string& note : comparison.notes) remarks.push_back(printable(note, kAll));
  return remarks;
}

std::string comparison_text(const RunComparison& comparison, bool all, std::size_t width) {
  std::string text = comparison_summary(comparison) + "\n";
  std::vector<std::vector<std::string>> cells;
  for (const ComparisonLine& line : comparison_lines(comparison, all))
    cells.push_back({std::string(to_string(line.verdict)), line.run, line.gate, line.message});
  if (!cells.empty()) text += fmt::format("\n{}", text::fitted_columns(cells, width));
  const std::vector<std::string> remarks = comparison_remarks(comparison);
  if (!remarks.empty()) text += "\n";
  for (const std::string& remark : remarks) text += remark + "\n";
  const std::size_t unchanged = comparison.count(GateVerdict::unchanged);
  if (!all && unchanged > 0)
    text += fmt::format("\n{} unchanged (--all shows them)\n", counted(unchanged, "gate"));
  // Who reads the end of a log alone must not take the gates that are unchanged for the verdict.
  if (!comparison.passed()) text += "\n" + comparison_summary(comparison) + "\n";
  return text;
}

}  // namespace fusebench::compare
