#include "eval/compare/aggregate/long_table.hpp"

#include <fmt/format.h>

#include <array>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "eval/text/json_text.hpp"
#include "eval/text/plain_table.hpp"

namespace fusebench::aggregate {

namespace {

constexpr std::array<const char*, 9> kIdentity = {"recording", "data",   "imu",    "truth", "variant",
                                                  "run",       "status", "reason", "label"};

std::array<std::string, kIdentity.size()> identity_of(const RunRow& row) {
  return {row.recording,
          row.data,
          row.imu,
          row.truth,
          row.variant,
          row.run,
          std::string(record::to_string(row.status)),
          row.reason,
          row.label};
}

/// Inclusive; empty where the frames are not known.
std::string last_frame_of(const RunRow& row) {
  return row.frames == 0 ? "" : fmt::format("{}", row.first_frame + row.frames - 1);
}

/// Calls add(metric, unit, value) for each number of the run; returns how many there were.
template <class Add>
std::size_t for_numbers(const RunRow& row, bool without_timing, const Add& add) {
  std::size_t numbers = 0;
  const auto given = [&](std::string_view metric, std::string_view unit, double value) {
    ++numbers;
    add(metric, unit, value);
  };
  if (row.total == 0) return 0;  // it did not begin
  for (const registry::RunMetric& metric : registry::run_metrics()) {
    if (metric.kind == registry::MetricKind::cost && without_timing) continue;
    if (const auto value = row.numbers[metric]) given(metric.key, metric.unit, *value);
  }
  return numbers;
}

void add_csv(const RunRow& row, const std::vector<std::string>& options, bool without_timing,
             std::string& text) {
  std::string prefix;
  for (const std::string& cell : identity_of(row)) prefix += text::csv_cell(cell) + ",";
  prefix += fmt::format("{},{},{},{},", row.first_frame, last_frame_of(row), row.repetition, row.replicate);
  for (const std::string& key : options) {
    const std::string_view value = option_of(row, key);
    prefix += (value == kUnsetOption ? std::string() : text::csv_cell(std::string(value))) + ",";
  }
  const std::size_t numbers =
      for_numbers(row, without_timing, [&](std::string_view metric, std::string_view unit, double value) {
        fmt::format_to(std::back_inserter(text), "{}{},{},{}\n", prefix, metric, unit, value);
      });
  if (numbers == 0) text += prefix + ",,\n";
}

std::string json_string(std::string_view text) { return text::json_text(std::string(text), -1); }

void add_json_lines(const RunRow& row, const std::vector<std::string>& options, bool without_timing,
                    std::string& text) {
  // The beginning is the same in all lines of a run, and most of the work.
  std::string prefix = "{";
  const auto identity = identity_of(row);
  for (std::size_t i = 0; i < kIdentity.size(); ++i)
    prefix += fmt::format("\"{}\":{},", kIdentity[i], json_string(identity[i]));
  const std::string last_frame = last_frame_of(row);
  prefix +=
      fmt::format("\"first_frame\":{},\"last_frame\":{},\"repetition\":{},\"replicate\":{},", row.first_frame,
                  last_frame.empty() ? "null" : last_frame, row.repetition, row.replicate);
  for (const std::string& key : options) {
    const std::string_view value = option_of(row, key);
    prefix += json_string(key) + ":" + (value == kUnsetOption ? "null" : json_string(value)) + ",";
  }
  const std::size_t numbers =
      for_numbers(row, without_timing, [&](std::string_view metric, std::string_view unit, double value) {
        fmt::format_to(std::back_inserter(text), "{}\"metric\":\"{}\",\"unit\":\"{}\",\"value\":{}}}\n",
                       prefix, metric, unit, value);
      });
  if (numbers == 0) text += prefix + "\"metric\":null,\"unit\":null,\"value\":null}\n";
}

}  // namespace

Result<LongFormat> parse_long_format(std::string_view text) {
  if (text == "csv") return LongFormat::csv;
  if (text == "jsonl") return LongFormat::json_lines;
  return fail(ErrorCode::usage, fmt::format("--format {} (allowed: csv | jsonl)", text));
}

std::string long_table(std::span<const RunRow> rows, const LongTableRequest& request) {
  const std::vector<std::string> options = edited_options(rows);
  std::string text;
  if (request.format == LongFormat::json_lines) {
    for (const RunRow& row : rows) add_json_lines(row, options, request.without_timing, text);
    return text;
  }
  for (const char* column : kIdentity) text += fmt::format("{},", column);
  text += "first_frame,last_frame,repetition,replicate,";
  for (const std::string& key : options) text += text::csv_cell(key) + ",";
  text += "metric,unit,value\n";
  for (const RunRow& row : rows) add_csv(row, options, request.without_timing, text);
  return text;
}

}  // namespace fusebench::aggregate
