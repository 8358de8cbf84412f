#include "eval/compare/tables/pivot_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "eval/record/run_files/run_set.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

namespace {

struct Pivot {
  struct Line {
    std::string recording;
    std::vector<const TableRow*> cells;  ///< one a method; null where it was not run

    /// Whether it tracked so few frames that its errors do not compare with those of the best-covered run.
    [[nodiscard]] bool is_sparse(const TableRow& row) const {
      return std::ranges::any_of(cells, [&](const TableRow* other) {
        return other != nullptr && row.tracked_share() < kLeastCoverage * other->tracked_share();
      });
    }
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

/// "1.68", "1.68 (20 %)" of a run that tracked few frames, "1.68 *" of one that contradicts the ground truth.
std::string shown_cell(const Pivot::Line& line, const TableRow* row, const registry::RunMetric& metric) {
  if (row == nullptr) return "";
  if (row->status != record::RunStatus::ok) return std::string(record::to_string(row->status));
  std::string text = shown_value(metric, *row);
  if (metric.better != registry::Better::smaller || !row->numbers[metric]) return text;
  if (line.is_sparse(*row)) text += fmt::format(" ({:.0f} %)", 100 * row->tracked_share());
  if (row->contradicts_truth) text += " *";
  return text;
}

std::optional<double> number_of(const TableRow* row, const registry::RunMetric& metric) {
  if (row == nullptr || row->status != record::RunStatus::ok) return std::nullopt;
  return row->numbers[metric];
}

/// Columns of the cells that are shown as the best of a line, of which sparse ones are none.
std::vector<std::size_t> best_of(const Pivot::Line& line, const registry::RunMetric& metric) {
  const bool smaller = metric.better == registry::Better::smaller;
  if (metric.better == registry::Better::neither) return {};
  std::optional<double> best;
  std::size_t numbers = 0;
  const auto compared = [&](const TableRow* row) {
    const auto number = number_of(row, metric);
    return number && !(smaller && line.is_sparse(*row)) ? number : std::nullopt;
  };
  for (const TableRow* row : line.cells) {
    numbers += number_of(row, metric) ? 1U : 0U;
    if (const auto number = compared(row))
      best = smaller ? std::min(*number, best.value_or(*number)) : std::max(*number, best.value_or(*number));
  }
  if (numbers < 2 || !best) return {};
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < line.cells.size(); ++c) {
    const auto number = compared(line.cells[c]);
    if (number && shown_value(metric, number) == shown_value(metric, best)) columns.push_back(c + 1);
  }
  return columns;
}

/// What the marks of shown_cell() mean.
std::vector<std::string> footnotes_of(const Pivot& pivot, const registry::RunMetric& metric) {
  std::vector<std::string> notes = {fmt::format("{}: {}.", metric.heading, metric.definition)};
  const auto any = [&](const auto& is_marked) {
    return metric.better == registry::Better::smaller &&
           std::ranges::any_of(pivot.lines, [&](const Pivot::Line& line) {
             return std::ranges::any_of(line.cells, [&](const TableRow* row) {
               return number_of(row, metric) && is_marked(line, *row);
             });
           });
  };
  if (any([](const Pivot::Line& line, const TableRow& row) { return line.is_sparse(row); }))
    notes.push_back(
        fmt::format("(%): share of frames tracked, where it is below {:.0f} % of that of another "
                    "run of the recording; never the best.",
                    100 * kLeastCoverage));
  if (any([](const Pivot::Line&, const TableRow& row) { return row.contradicts_truth; }))
    notes.emplace_back("*: the poses contradict the ground truth; the table of runs has the numbers.");
  return notes;
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
    for (const TableRow* row : line.cells) cells.cells.push_back(shown_cell(line, row, metric));
    cells.bold = best_of(line, metric);
  }
  latex.footnotes = footnotes_of(pivot, metric);
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
  std::string text = text::markdown_table(lines, 1, width) + "\n";
  for (const std::string& note : latex.footnotes) text += note + "\n";
  return text;
}

}  // namespace fusebench::tables
