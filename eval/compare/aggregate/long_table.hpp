// All numbers of all runs of a folder in one long table, for other programs.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::aggregate {

enum class LongFormat { csv, json_lines };
/// "csv" or "jsonl". Error usage.
[[nodiscard]] Result<LongFormat> parse_long_format(std::string_view text);

struct LongTableRequest {
  LongFormat format = LongFormat::csv;
  /// Leaves out the numbers that are never the same twice, so that two folders compare byte for byte.
  bool without_timing = false;
};

/// A line for each number of each run: recording, data, imu, truth, variant, run, status, reason, label (of
/// RunRow), first and last frame, repetition, replicate, each option that any of the runs edits, metric,
/// unit, value (SI). A run without numbers has one line, in which the last three are empty (null). Numbers
/// that depend on the inputs alone come first. CSV is as RFC 4180 with "\n".
[[nodiscard]] std::string long_table(std::span<const RunRow> rows, const LongTableRequest& request);

}  // namespace fusebench::aggregate
