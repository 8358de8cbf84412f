#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/base/geometry.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/tables/latex_table.hpp"
#include "eval/tables/table.hpp"
#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::tables {

namespace {

using Cells = text::TableCells;
using Json = nlohmann::ordered_json;

constexpr std::size_t kTextColumns = 5;  // recording, data, IMU, variant, status: left-aligned

Cells header_cells() {
  Cells cells = {"recording", "data", "IMU", "variant", "status"};
  for (const TableColumn& column : table_columns()) cells.emplace_back(column.heading);
  cells.insert(cells.end(), {"tracked", "vertices", "fps"});
  return cells;
}

void add_values(const TableValues& values, Cells& cells) {
  for (const TableColumn& column : table_columns())
    cells.push_back(shown_value(column, values.*column.value));
}

Cells shown_cells(const TableRow& row) {
  Cells cells = {row.recording, record::data_cell({row.data, row.imu, row.truth}), row.imu, row.label,
                 record::status_text(row.status, row.silent)};
  add_values(row, cells);
  cells.insert(cells.end(),
               {fmt::format("{}/{}", row.tracked, row.total),
                row.vertices ? fmt::format("{}", *row.vertices) : "-", text::number_cell(row.fps, 1, 1)});
  return cells;
}

/// Parts of one recording are counted as such: a mean over them is another one than over whole recordings.
std::string mean_over(const TableMean& mean) {
  if (mean.windows <= mean.recordings) return fmt::format("mean over {} recordings", mean.recordings);
  return fmt::format("mean over {} windows of {} recordings", mean.windows, mean.recordings);
}

Cells shown_cells(const TableMean& mean) {
  Cells cells = {mean_over(mean), record::data_cell({mean.data, mean.imu, mean.truth}), mean.imu, mean.label,
                 mean.silent > 0 ? fmt::format("{}/{} ok ({} run{} silent)", mean.ok, mean.total, mean.silent,
                                               mean.silent == 1 ? "" : "s")
                                 : fmt::format("{}/{} ok", mean.ok, mean.total)};
  add_values(mean.values, cells);
  cells.insert(cells.end(), {"", "", ""});
  return cells;
}

std::string count_line(const ResultTable& table) {
  const auto ok = std::count_if(table.rows.begin(), table.rows.end(),
                                [](const TableRow& row) { return row.status == record::RunStatus::ok; });
  const auto silent =
      std::ranges::count_if(table.rows, [](const TableRow& row) { return row.silent.value_or(0) > 0; });
  return fmt::format("{} of {} runs ok{}.", ok, table.rows.size(),
                     silent > 0 ? fmt::format(", {} with silent failures", silent) : "");
}

std::string markdown(const ResultTable& table, std::size_t width) {
  std::string text = text::markdown_table(table_cells(table), kTextColumns, width);
  text += fmt::format("\n{}\n", count_line(table));
  for (const std::string& note : table.notes) text += fmt::format("- {}\n", note);
  text += "\n";
  for (const std::string& line : table.footer) text += line + "\n";
  return text;
}

std::string latex(const ResultTable& table, const LatexLayout& layout) {
  LatexTable latex;
  latex.caption =
      "Each run, and means over recordings. Bold: the best of a recording's runs that are ok over the same "
      "frames.";
  latex.label = "runs";
  latex.heading = header_cells();
  latex.text_columns = kTextColumns;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    latex.lines.push_back({shown_cells(table.rows[i]), best_cells(table, table.rows[i]),
                           i > 0 && table.rows[i].recording != table.rows[i - 1].recording});
  }
  for (std::size_t i = 0; i < table.means.size(); ++i)
    latex.lines.push_back({shown_cells(table.means[i]), {}, i == 0});
  latex.footnotes = {count_line(table)};
  latex.footnotes.insert(latex.footnotes.end(), table.notes.begin(), table.notes.end());
  latex.footnotes.insert(latex.footnotes.end(), table.footer.begin(), table.footer.end());
  return latex_table(latex, layout);
}

std::string csv_identity(const TableRow& row) {
  std::string options;
  for (const auto& [key, value] : row.edits)
    options += fmt::format("{}{}={}", options.empty() ? "" : " ", key, value);
  return fmt::format("{},{},{},{},{},{},{},{},{},{}", text::csv_cell(row.recording), text::csv_cell(row.data),
                     text::csv_cell(row.imu), text::csv_cell(row.truth), text::csv_cell(row.variant),
                     text::csv_cell(row.run), text::csv_cell(options), row.first_frame, row.repetition,
                     record::to_string(row.status));
}

std::string csv(const ResultTable& table) {
  std::string text = "recording,data,imu,truth,variant,run,options,first_frame,repetition,status,reason";
  for (const TableColumn& column : table_columns()) text += fmt::format(",{}", column.key);
  text += ",silent,tracked,total,vertices,fps\n";
  for (const TableRow& row : table.rows) {
    text += fmt::format("{},{}", csv_identity(row), text::csv_cell(row.reason));
    for (const TableColumn& column : table_columns())
      text += row.*column.value ? fmt::format(",{}", *(row.*column.value)) : ",";
    text += fmt::format(",{},{},{},{},{}\n", row.silent ? fmt::format("{}", *row.silent) : "", row.tracked,
                        row.total, row.vertices ? fmt::format("{}", *row.vertices) : "",
                        row.fps ? fmt::format("{}", *row.fps) : "");
  }
  return text;
}

std::string csv_long(const ResultTable& table) {
  std::string text =
      "recording,data,imu,truth,variant,run,options,first_frame,repetition,status,metric,unit,value\n";
  for (const TableRow& row : table.rows) {
    const auto add = [&](const char* metric, const char* unit, double value) {
      text += fmt::format("{},{},{},{}\n", csv_identity(row), metric, unit, value);
    };
    for (const TableColumn& column : table_columns()) {
      if (row.*column.value) add(column.key, column.unit, *(row.*column.value));
    }
    if (row.silent) add("silent", "frames", static_cast<double>(*row.silent));
    add("tracked", "frames", static_cast<double>(row.tracked));
    add("total", "frames", static_cast<double>(row.total));
    if (row.vertices) add("vertices", "", static_cast<double>(*row.vertices));
    if (row.fps) add("fps", "1/s", *row.fps);
  }
  return text;
}

Json json_of(const TableValues& values) {
  Json json = Json::object();
  for (const TableColumn& column : table_columns())
    json[column.key] = values.*column.value ? Json(*(values.*column.value)) : Json(nullptr);
  return json;
}

std::string json(const ResultTable& table) {
  Json rows = Json::array();
  for (const TableRow& row : table.rows) {
    Json options = Json::object();
    for (const auto& [key, value] : row.edits) options[key] = value;
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
    json.update(json_of(row));
    json.update(Json{{"silent", row.silent ? Json(*row.silent) : Json(nullptr)},
                     {"tracked", row.tracked},
                     {"total", row.total},
                     {"vertices", row.vertices ? Json(*row.vertices) : Json(nullptr)},
                     {"fps", row.fps ? Json(*row.fps) : Json(nullptr)}});
    rows.push_back(std::move(json));
  }
  Json means = Json::array();
  for (const TableMean& mean : table.means) {
    Json json = {{"data", mean.data},       {"imu", mean.imu},       {"truth", mean.truth},
                 {"variant", mean.variant}, {"label", mean.label},   {"recordings", mean.recordings},
                 {"n_ok", mean.ok},         {"n_total", mean.total}, {"n_silent", mean.silent},
                 {"windows", mean.windows}};
    json.update(json_of(mean.values));
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

std::string shown_value(const TableColumn& column, const std::optional<double>& value) {
  return text::number_cell(value, column.shown_factor, column.decimals);
}

std::vector<std::size_t> best_cells(const ResultTable& table, const TableRow& row) {
  std::vector<std::size_t> best;
  for (std::size_t c = 0; c < table_columns().size(); ++c) {
    const TableColumn& column = table_columns()[c];
    std::size_t others = 0;
    bool is_best = row.status == record::RunStatus::ok && (row.*column.value).has_value();
    for (const TableRow& other : table.rows) {
      if (!is_best || &other == &row || other.recording != row.recording) continue;
      if (other.first_frame != row.first_frame || other.total != row.total) continue;
      if (other.status != record::RunStatus::ok || !(other.*column.value)) continue;
      ++others;
      is_best = *(row.*column.value) <= *(other.*column.value) ||
                shown_value(column, row.*column.value) == shown_value(column, other.*column.value);
    }
    if (is_best && others > 0) best.push_back(kTextColumns + c);
  }
  return best;
}

std::vector<Cells> table_cells(const ResultTable& table) {
  std::vector<Cells> lines = {header_cells()};
  for (const TableRow& row : table.rows) lines.push_back(shown_cells(row));
  for (const TableMean& mean : table.means) lines.push_back(shown_cells(mean));
  return lines;
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
  switch (format) {
    case TableFormat::markdown:
      return markdown(table, width);
    case TableFormat::csv:
      return csv(table);
    case TableFormat::csv_long:
      return csv_long(table);
    case TableFormat::json:
      return json(table);
    case TableFormat::latex:
      return latex(table, layout);
  }
  return {};
}

}  // namespace fusebench::tables
