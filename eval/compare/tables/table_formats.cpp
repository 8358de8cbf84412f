#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "eval/compare/tables/latex_table.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/text/control_characters.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

namespace {

using Cells = text::TableCells;
using Json = nlohmann::ordered_json;

constexpr std::size_t kTextColumns = 5;  // recording, data, IMU, variant, status: left-aligned

std::span<const registry::RunMetric* const> columns() { return registry::columns_of(registry::Column::runs); }

/// Numbers of a run that files have beside the columns.
constexpr std::array<std::string_view, 5> kBeside = {"silent_failures", "frames_tracked", "frames_total",
                                                     "model_vertices", "fps"};

/// All metrics that files have of a run.
std::vector<const registry::RunMetric*> file_metrics() {
  std::vector<const registry::RunMetric*> metrics(columns().begin(), columns().end());
  for (const std::string_view key : kBeside) metrics.push_back(&registry::run_metric(key));
  return metrics;
}

Cells header_cells(bool with_replicates) {
  Cells cells = {"recording", "data", "IMU", "variant", "status"};
  for (const registry::RunMetric* column : columns()) cells.emplace_back(column->heading);
  cells.insert(cells.end(), {"tracked", "vertices", "fps"});
  if (with_replicates) cells.emplace_back("sensitivity");
  return cells;
}

void add_values(const registry::RunNumbers& values, Cells& cells) {
  for (const registry::RunMetric* column : columns()) cells.push_back(shown_value(*column, values[*column]));
}

/// "ok", "ok (12 undetected)", and of replicates how many are: "4/5 ok (12 undetected)".
std::string status_cell(const TableRow& row) {
  if (row.members.size() < 2) return record::status_text(row.status, row.silent);
  return fmt::format("{}/{} {}", row.ok_members, row.members.size(),
                     record::status_text(record::RunStatus::ok, row.silent));
}

Cells shown_cells(const TableRow& row, bool with_replicates) {
  Cells cells = {row.recorded_part(), record::data_cell({row.data, row.imu, row.truth}), row.imu, row.label,
                 status_cell(row)};
  for (const registry::RunMetric* column : columns()) cells.push_back(shown_value(*column, row));
  cells.push_back(fmt::format("{}/{}", row.tracked, row.total));
  for (const std::string_view key : {"model_vertices", "fps"})
    cells.push_back(shown_value(registry::run_metric(key), row.numbers[key]));
  if (with_replicates) cells.push_back(text::number_cell(registry::sensitivity_of(row.replicates), 1, 2));
  return cells;
}

/// Parts of one recording are counted as such: a mean over them is another one than over whole recordings.
std::string mean_over(const TableMean& mean) {
  if (mean.windows <= mean.recordings) return fmt::format("mean over {} recordings", mean.recordings);
  return fmt::format("mean over {} windows of {} recordings", mean.windows, mean.recordings);
}

Cells shown_cells(const TableMean& mean, bool with_replicates) {
  Cells cells = {mean_over(mean), record::data_cell({mean.data, mean.imu, mean.truth}), mean.imu, mean.label,
                 mean.silent > 0 ? fmt::format("{}/{} ok ({} run{} with undetected failures)", mean.ok,
                                               mean.total, mean.silent, mean.silent == 1 ? "" : "s")
                                 : fmt::format("{}/{} ok", mean.ok, mean.total)};
  add_values(mean.values, cells);
  cells.insert(cells.end(), with_replicates ? 4 : 3, "");
  return cells;
}

std::string count_line(const ResultTable& table) {
  const auto ok = std::count_if(table.rows.begin(), table.rows.end(),
                                [](const TableRow& row) { return row.status == record::RunStatus::ok; });
  const auto silent =
      std::ranges::count_if(table.rows, [](const TableRow& row) { return row.silent.value_or(0) > 0; });
  return fmt::format("{} of {} runs ok{}.", ok, table.rows.size(),
                     silent > 0 ? fmt::format(", {} with undetected failures", silent) : "");
}

std::string markdown(const ResultTable& table, std::size_t width) {
  std::string text = text::markdown_table(table_cells(table), kTextColumns, width);
  text += fmt::format("\n{}\n", count_line(table));
  for (const std::string& note : table.notes) text += fmt::format("- {}\n", text::without_controls(note));
  text += "\n";
  for (const std::string& line : table.footer) text += line + "\n";
  return text;
}

/// Keys of the columns of numbers, in their order.
std::vector<std::string> column_keys() {
  std::vector<std::string> keys;
  for (const registry::RunMetric* column : columns()) keys.emplace_back(column->key);
  keys.insert(keys.end(), {"frames_tracked", "model_vertices", "fps"});
  return keys;
}

/// Keeps the names and the columns of those numbers.
void keep_columns(const std::vector<std::string>& metrics, LatexTable& table) {
  const std::vector<std::string> keys = column_keys();
  std::vector<std::size_t> kept;
  for (std::size_t column = 0; column < table.heading.size(); ++column) {
    const bool is_name = column < table.text_columns;
    const std::size_t place = is_name ? 0 : column - table.text_columns;
    if (is_name || (place < keys.size() && std::ranges::find(metrics, keys[place]) != metrics.end()))
      kept.push_back(column);
  }
  table.heading = chosen({table.heading}, kept).cells;
  for (LatexTable::Line& line : table.lines) line = chosen(line, kept);
}

/// Whether a line of the footer, "ATE: rmse ...", is of a column that the heading does not have.
bool explains_other_column(const std::string& line, const Cells& heading, bool with_replicates) {
  const std::string name = line.substr(0, line.find(':'));
  const auto has_name = [&](const std::string& cell) {
    return cell == name || cell.starts_with(name + " [");
  };
  return std::ranges::any_of(header_cells(with_replicates), has_name) &&
         std::ranges::none_of(heading, has_name);
}

std::string latex(const ResultTable& table, const LatexLayout& layout) {
  LatexTable latex;
  latex.caption =
      "Each run, and means over recordings. Bold: the best of a recording's runs that are ok over the same "
      "frames.";
  latex.label = "runs";
  const bool replicates = has_replicates(table);
  latex.heading = header_cells(replicates);
  latex.text_columns = kTextColumns;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    latex.lines.push_back({shown_cells(table.rows[i], replicates), best_cells(table, table.rows[i]),
                           i > 0 && table.rows[i].recording != table.rows[i - 1].recording});
  }
  for (std::size_t i = 0; i < table.means.size(); ++i)
    latex.lines.push_back({shown_cells(table.means[i], replicates), {}, i == 0});
  if (!layout.metrics.empty()) keep_columns(layout.metrics, latex);
  latex.footnotes = {count_line(table)};
  latex.footnotes.insert(latex.footnotes.end(), table.notes.begin(), table.notes.end());
  for (const std::string& line : table.footer) {
    if (!explains_other_column(line, latex.heading, replicates)) latex.footnotes.push_back(line);
  }
  return latex_table(latex, layout);
}

std::string csv_identity(const TableRow& row) {
  std::string options;
  for (const auto& [key, value] : row.options)
    options += fmt::format("{}{}={}", options.empty() ? "" : " ", key, value);
  return fmt::format("{},{},{},{},{},{},{},{},{},{}", text::csv_cell(row.recording), text::csv_cell(row.data),
                     text::csv_cell(row.imu), text::csv_cell(row.truth), text::csv_cell(row.variant),
                     text::csv_cell(row.run), text::csv_cell(options), row.first_frame, row.repetition,
                     record::to_string(row.status));
}

std::string csv(const ResultTable& table) {
  std::string text = "recording,data,imu,truth,variant,run,options,first_frame,repetition,status,reason";
  for (const registry::RunMetric* metric : file_metrics()) text += fmt::format(",{}", metric->key);
  text += ",replicates,sensitivity\n";
  for (const TableRow& row : table.rows) {
    text += fmt::format("{},{}", csv_identity(row), text::csv_cell(row.reason));
    for (const registry::RunMetric* metric : file_metrics()) {
      const auto value = row.numbers[*metric];
      text += value ? fmt::format(",{}", *value) : ",";
    }
    const auto sensitivity = registry::sensitivity_of(row.replicates);
    text += fmt::format(",{},{}\n", row.members.size(), sensitivity ? fmt::format("{}", *sensitivity) : "");
  }
  return text;
}

std::string csv_long(const ResultTable& table) {
  std::string text =
      "recording,data,imu,truth,variant,run,options,first_frame,repetition,status,metric,unit,value\n";
  for (const TableRow& row : table.rows) {
    for (const registry::RunMetric* metric : file_metrics()) {
      if (const auto value = row.numbers[*metric])
        text += fmt::format("{},{},{},{}\n", csv_identity(row), metric->key, metric->unit, *value);
    }
  }
  return text;
}

Json json_of(const registry::RunNumbers& numbers, std::span<const registry::RunMetric* const> metrics) {
  Json json = Json::object();
  for (const registry::RunMetric* metric : metrics) {
    const auto value = numbers[*metric];
    json[std::string(metric->key)] = value ? Json(*value) : Json(nullptr);
  }
  return json;
}

/// {"ate_rmse_m": [least, most], ...} over the replicates.
Json ranges_of(const TableRow& row) {
  Json json = Json::object();
  for (const registry::RunMetric* metric : file_metrics()) {
    if (const auto range = registry::median_range(row.replicates, *metric))
      json[std::string(metric->key)] = {range->least, range->most};
  }
  return json;
}

std::string json(const ResultTable& table) {
  Json rows = Json::array();
  for (const TableRow& row : table.rows) {
    Json options = Json::object();
    for (const auto& [key, value] : row.options) options[key] = value;
    Json json = {{"recording", row.recording},
                 {"data", row.data},
                 {"imu", row.imu},
                 {"truth", row.truth},
                 {"variant", row.variant},
                 {"label", row.label},
                 {"options", std::move(options)},
                 {"first_frame", row.first_frame},
                 {"repetition", row.repetition},
                 {"run", row.run},
                 {"status", record::to_string(row.status)},
                 {"reason", row.reason}};
    json.update(json_of(row.numbers, file_metrics()));
    json["replicates"] = row.members.size();
    if (row.replicates.size() > 1) json["ranges"] = ranges_of(row);
    rows.push_back(std::move(json));
  }
  Json means = Json::array();
  for (const TableMean& mean : table.means) {
    Json json = {{"data", mean.data},       {"imu", mean.imu},       {"truth", mean.truth},
                 {"variant", mean.variant}, {"label", mean.label},   {"recordings", mean.recordings},
                 {"n_ok", mean.ok},         {"n_total", mean.total}, {"n_silent", mean.silent},
                 {"windows", mean.windows}};
    json.update(json_of(mean.values, columns()));
    means.push_back(std::move(json));
  }
  const auto ok = std::count_if(table.rows.begin(), table.rows.end(),
                                [](const TableRow& row) { return row.status == record::RunStatus::ok; });
  const Json document = {{"n_ok", ok},
                         {"n_total", table.rows.size()},
                         {"rows", std::move(rows)},
                         {"means", std::move(means)},
                         {"notes", table.notes},
                         {"protocol", table.footer}};
  return text::json_text(document) + "\n";
}

}  // namespace

std::string shown_value(const registry::RunMetric& metric, const TableRow& row) {
  if (row.replicates.size() < 2 || metric.takes_several_runs())
    return shown_value(metric, row.numbers[metric]);
  return registry::shown_text(metric, registry::median_range(row.replicates, metric));
}

std::string shown_value(const registry::RunMetric& metric, const std::optional<double>& value) {
  return text::number_cell(value, metric.shown_factor, metric.decimals);
}

/// Whether the ranges over replicates overlap, so that chance explains the difference.
bool overlap(const TableRow& a, const TableRow& b, const registry::RunMetric& metric) {
  if (a.replicates.size() < 2 || b.replicates.size() < 2) return false;
  const auto of_a = registry::median_range(a.replicates, metric);
  const auto of_b = registry::median_range(b.replicates, metric);
  return of_a && of_b && of_a->overlaps(*of_b);
}

std::vector<std::size_t> best_cells(const ResultTable& table, const TableRow& row) {
  std::vector<std::size_t> best;
  for (std::size_t c = 0; c < columns().size(); ++c) {
    const registry::RunMetric& column = *columns()[c];
    const std::optional<double> value = row.numbers[column];
    std::size_t others = 0;
    bool is_best = row.status == record::RunStatus::ok && value;
    for (const TableRow& other : table.rows) {
      if (!is_best || &other == &row || other.recording != row.recording) continue;
      if (other.first_frame != row.first_frame || other.total != row.total) continue;
      const std::optional<double> of_other = other.numbers[column];
      if (other.status != record::RunStatus::ok || !of_other) continue;
      ++others;
      is_best = *value <= *of_other || shown_value(column, value) == shown_value(column, of_other) ||
                overlap(row, other, column);
    }
    if (is_best && others > 0) best.push_back(kTextColumns + c);
  }
  return best;
}

std::vector<Cells> table_cells(const ResultTable& table) {
  const bool replicates = has_replicates(table);
  std::vector<Cells> lines = {header_cells(replicates)};
  for (const TableRow& row : table.rows) lines.push_back(shown_cells(row, replicates));
  for (const TableMean& mean : table.means) lines.push_back(shown_cells(mean, replicates));
  return lines;
}

Result<void> check_latex_metrics(const std::vector<std::string>& keys) {
  const std::vector<std::string> known = column_keys();
  for (const std::string& key : keys) {
    if (std::ranges::find(known, key) != known.end()) continue;
    return fail(ErrorCode::usage,
                fmt::format("--metrics {}: the table of runs has no such column (allowed: {})", key,
                            fmt::join(known, " | ")));
  }
  return {};
}

Result<TableFormat> parse_table_format(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, TableFormat>, 5> kFormats = {
      {{"markdown", TableFormat::markdown},
       {"csv", TableFormat::csv},
       {"csv-long", TableFormat::csv_long},
       {"json", TableFormat::json},
       {"latex", TableFormat::latex}}};
  for (const auto& [name, format] : kFormats) {
    if (name == text) return format;
  }
  return fail(ErrorCode::usage,
              fmt::format("--format {} (allowed: markdown | csv | csv-long | json | latex)", text));
}

std::string render_table(const ResultTable& table, TableFormat format, const LatexLayout& layout,
                         std::size_t width) {
  if (format == TableFormat::json) return json(table);
  if (format == TableFormat::latex) return latex(table, layout);
  if (format == TableFormat::csv) return csv(table);
  if (format == TableFormat::csv_long) return csv_long(table);
  return markdown(table, width);
}

}  // namespace fusebench::tables
