#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/geometry.hpp"
#include "eval/json_text.hpp"
#include "eval/report/data_labels.hpp"
#include "eval/report/table.hpp"

namespace fusebench {

namespace {

using Cells = std::vector<std::string>;

constexpr std::size_t kTextColumns = 5;  // recording, data, IMU, variant, status: left-aligned

std::string shown(const std::optional<double>& value, double factor, int decimals) {
  return value ? fmt::format("{:.{}f}", *value * factor, decimals) : "-";
}

Cells header_cells() {
  return {"recording", "data",       "IMU",         "variant", "status",   "AIE", "AIE common",
          "ATE [cm]",  "RPE [cm/s]", "RPE [deg/s]", "tracked", "vertices", "fps"};
}

/// The run's name is shown only where the same variant occurs twice.
bool repeated(const ResultTable& table, const TableRow& row) {
  return std::count_if(table.rows.begin(), table.rows.end(), [&](const TableRow& other) {
           return other.recording == row.recording && other.variant == row.variant;
         }) > 1;
}

Cells shown_cells(const ResultTable& table, const TableRow& row) {
  return {row.recording,
          data_cell({row.data, row.imu, row.truth}),
          row.imu,
          repeated(table, row) ? fmt::format("{} ({})", row.variant, row.run) : row.variant,
          std::string(to_string(row.status)),
          shown(row.aie_grey, 1, 3),
          shown(row.aie_common_grey, 1, 3),
          shown(row.ate_rmse_m, 100, 2),
          shown(row.rpe_second_m, 100, 2),
          shown(row.rpe_second_rad, kDegreesPerRadian, 2),
          fmt::format("{}/{}", row.tracked, row.total),
          fmt::format("{}", row.vertices),
          fmt::format("{:.1f}", row.fps)};
}

std::string count_line(const ResultTable& table) {
  const auto ok = std::count_if(table.rows.begin(), table.rows.end(),
                                [](const TableRow& row) { return row.status == RunStatus::ok; });
  return fmt::format("{} of {} runs ok.", ok, table.rows.size());
}

std::string replaced(std::string_view text, std::string_view special, std::string_view escape) {
  std::string result;
  for (const char c : text) {
    if (special.find(c) != std::string_view::npos) result += escape;
    result += c;
  }
  return result;
}

std::string markdown(const ResultTable& table) {
  std::vector<Cells> lines = table_cells(table);
  for (Cells& line : lines) {
    for (std::string& cell : line) cell = replaced(cell, "|", "\\");
  }
  std::vector<std::size_t> widths(lines[0].size(), 3);
  for (const Cells& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    text += "|";
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += i < kTextColumns ? fmt::format(" {:<{}} |", lines[k][i], widths[i])
                               : fmt::format(" {:>{}} |", lines[k][i], widths[i]);
    }
    text += "\n";
    if (k > 0) continue;
    text += "|";
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += i < kTextColumns ? fmt::format(" {:-<{}} |", "", widths[i])
                               : fmt::format(" {:->{}}: |", "", widths[i] - 1);
    }
    text += "\n";
  }
  text += fmt::format("\n{}\n", count_line(table));
  for (const std::string& note : table.notes) text += fmt::format("- {}\n", note);
  text += "\n";
  for (const std::string& line : table.footer) text += line + "\n";
  return text;
}

std::string latex(const ResultTable& table) {
  const auto escaped = [](std::string_view text) { return replaced(text, "_&%#$", "\\"); };
  const auto line_of = [&](const Cells& cells) {
    std::string line;
    for (const std::string& cell : cells) line += (line.empty() ? "" : " & ") + escaped(cell);
    return line + " \\\\\n";
  };
  const Cells header = header_cells();
  std::string text =
      fmt::format("% requires \\usepackage{{booktabs}}\n\\begin{{tabular}}{{{}{}}}\n\\toprule\n",
                  std::string(kTextColumns, 'l'), std::string(header.size() - kTextColumns, 'r'));
  text += line_of(header) + "\\midrule\n";
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (i > 0 && table.rows[i].recording != table.rows[i - 1].recording) text += "\\midrule\n";
    text += line_of(shown_cells(table, table.rows[i]));
  }
  text += "\\bottomrule\n\\end{tabular}\n% " + count_line(table) + "\n";
  for (const std::string& note : table.notes) text += fmt::format("% {}\n", note);
  for (const std::string& line : table.footer) text += fmt::format("% {}\n", line);
  return text;
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv(const ResultTable& table) {
  std::string text =
      "recording,data,imu,truth,variant,run,status,reason,aie_grey,aie_common_grey,ate_rmse_m,rpe_1s_m,rpe_"
      "1s_rad,"
      "tracked,total,"
      "vertices,fps\n";
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{}", *value) : "";
  };
  for (const TableRow& row : table.rows) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_cell(row.recording),
                        row.data, csv_cell(row.imu), csv_cell(row.truth), csv_cell(row.variant), row.run,
                        to_string(row.status), csv_cell(row.reason), number(row.aie_grey),
                        number(row.aie_common_grey), number(row.ate_rmse_m), number(row.rpe_second_m),
                        number(row.rpe_second_rad), row.tracked, row.total, row.vertices, row.fps);
  }
  return text;
}

std::string json(const ResultTable& table) {
  using Json = nlohmann::ordered_json;
  const auto number = [](const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); };
  Json rows = Json::array();
  for (const TableRow& row : table.rows) {
    rows.push_back({{"recording", row.recording},
                    {"data", row.data},
                    {"imu", row.imu},
                    {"truth", row.truth},
                    {"variant", row.variant},
                    {"run", row.run},
                    {"status", to_string(row.status)},
                    {"reason", row.reason},
                    {"aie_grey", number(row.aie_grey)},
                    {"aie_common_grey", number(row.aie_common_grey)},
                    {"ate_rmse_m", number(row.ate_rmse_m)},
                    {"rpe_1s_m", number(row.rpe_second_m)},
                    {"rpe_1s_rad", number(row.rpe_second_rad)},
                    {"tracked", row.tracked},
                    {"total", row.total},
                    {"vertices", row.vertices},
                    {"fps", row.fps}});
  }
  const auto ok = std::count_if(table.rows.begin(), table.rows.end(),
                                [](const TableRow& row) { return row.status == RunStatus::ok; });
  const Json document = {{"n_ok", ok},
                         {"n_total", table.rows.size()},
                         {"rows", rows},
                         {"notes", table.notes},
                         {"protocol", table.footer}};
  return json_text(document) + "\n";
}

}  // namespace

std::vector<Cells> table_cells(const ResultTable& table) {
  std::vector<Cells> lines = {header_cells()};
  for (const TableRow& row : table.rows) lines.push_back(shown_cells(table, row));
  return lines;
}

Result<TableFormat> parse_table_format(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, TableFormat>, 4> kFormats = {
      {{"markdown", TableFormat::markdown},
       {"csv", TableFormat::csv},
       {"json", TableFormat::json},
       {"latex", TableFormat::latex}}};
  for (const auto& [name, format] : kFormats) {
    if (name == text) return format;
  }
  return fail(ErrorCode::usage, fmt::format("--format {} (allowed: markdown | csv | json | latex)", text));
}

std::string render_table(const ResultTable& table, TableFormat format) {
  switch (format) {
    case TableFormat::markdown:
      return markdown(table);
    case TableFormat::csv:
      return csv(table);
    case TableFormat::json:
      return json(table);
    case TableFormat::latex:
      return latex(table);
  }
  return {};
}

}  // namespace fusebench
