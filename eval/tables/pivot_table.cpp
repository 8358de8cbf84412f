#include "eval/tables/pivot_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "eval/run_files/run_set.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

namespace {

struct Pivot {
  struct Line {
    std::string recording;
    std::vector<const TableRow*> cells;  ///< one a method; null where it was not run
  };
  std::vector<std::string> methods;
  std::vector<Line> lines;
};

std::size_t place_in(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  const auto place = static_cast<std::size_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return place;
}

Pivot pivot_of(const ResultTable& table) {
  const run_files::RunSet rows(std::vector<run_files::RunIdentity>(table.rows.begin(), table.rows.end()));
  const std::vector<std::string> labels = rows.configuration_labels();
  Pivot pivot;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const TableRow& row = table.rows[i];
    const std::string name = row.recorded_part();
    const std::size_t line = place_in(names, name);
    const std::size_t method = place_in(pivot.methods, labels[i]);
    if (line == pivot.lines.size()) pivot.lines.push_back({name, {}});
    auto& cells = pivot.lines[line].cells;
    if (cells.size() <= method) cells.resize(method + 1, nullptr);
    if (cells[method] == nullptr) cells[method] = &row;
  }
  for (Pivot::Line& line : pivot.lines) line.cells.resize(pivot.methods.size(), nullptr);
  return pivot;
}

std::string shown_cell(const TableRow* row, const registry::RunMetric& metric) {
  if (row == nullptr) return "";
  return row->status == record::RunStatus::ok ? shown_value(metric, *row)
                                              : std::string(record::to_string(row->status));
}

std::optional<double> number_of(const TableRow* row, const registry::RunMetric& metric) {
  if (row == nullptr || row->status != record::RunStatus::ok) return std::nullopt;
  return row->numbers[metric];
}

/// Columns of the cells that are shown as the best of a line.
std::vector<std::size_t> best_of(const Pivot::Line& line, const registry::RunMetric& metric) {
  if (metric.better == registry::Better::neither) return {};
  std::vector<double> numbers;
  for (const TableRow* row : line.cells) {
    if (const auto number = number_of(row, metric)) numbers.push_back(*number);
  }
  if (numbers.size() < 2) return {};
  const double best = metric.better == registry::Better::smaller ? *std::ranges::min_element(numbers)
                                                                 : *std::ranges::max_element(numbers);
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < line.cells.size(); ++c) {
    const auto number = number_of(line.cells[c], metric);
    if (number && shown_value(metric, number) == shown_value(metric, std::optional(best)))
      columns.push_back(c + 1);
  }
  return columns;
}

LatexTable latex_of(const Pivot& pivot, const registry::RunMetric& metric) {
  LatexTable latex;
  latex.caption = fmt::format("{} by recording and method. Bold: the best of a recording.", metric.heading);
  latex.label = fmt::format("pivot-{}", metric.key);
  std::ranges::replace(latex.label, '_', '-');
  latex.heading = {"recording"};
  latex.heading.insert(latex.heading.end(), pivot.methods.begin(), pivot.methods.end());
  for (const Pivot::Line& line : pivot.lines) {
    LatexTable::Line& cells = latex.lines.emplace_back();
    cells.cells = {line.recording};
    for (const TableRow* row : line.cells) cells.cells.push_back(shown_cell(row, metric));
    cells.bold = best_of(line, metric);
  }
  latex.footnotes = {fmt::format("{}: {}.", metric.heading, metric.definition)};
  return latex;
}

std::string csv_of(const Pivot& pivot, const registry::RunMetric& metric) {
  std::string text = "recording";
  for (const std::string& method : pivot.methods) text += "," + text::csv_cell(method);
  text += "\n";
  for (const Pivot::Line& line : pivot.lines) {
    text += text::csv_cell(line.recording);
    for (const TableRow* row : line.cells) {
      const auto number = number_of(row, metric);
      text += number ? fmt::format(",{}", *number) : ",";
    }
    text += "\n";
  }
  return text;
}

}  // namespace

Result<std::string> render_pivot(const ResultTable& table, const registry::RunMetric& metric,
                                 TableFormat format, const LatexLayout& layout, std::size_t width) {
  const Pivot pivot = pivot_of(table);
  if (format == TableFormat::csv) return csv_of(pivot, metric);
  const LatexTable latex = latex_of(pivot, metric);
  if (format == TableFormat::latex) return latex_table(latex, layout);
  if (format != TableFormat::markdown)
    return fail(ErrorCode::usage, "--pivot has no such format (allowed: markdown | csv | latex)");
  std::vector<text::TableCells> lines = {latex.heading};
  for (const LatexTable::Line& line : latex.lines) lines.push_back(line.cells);
  return text::markdown_table(lines, 1, width) + fmt::format("\n{}\n", latex.footnotes.front());
}

}  // namespace fusebench::tables
