// The table of a folder of runs: one row per run, failed and lost ones included.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "eval/found_runs.hpp"
#include "eval/record.hpp"

namespace fusebench {

/// One run. Numbers that do not exist are absent, never 0 or NaN.
struct TableRow {
  std::string recording;
  std::string data;   ///< "recorded", "simulated"
  std::string imu;    ///< "none", "recorded", "synthetic IMU"
  std::string truth;  ///< "none", "given", kPseudoTruthWord
  std::string variant;
  std::string run;  ///< folder name, hash8
  RunStatus status = RunStatus::failed;
  std::string reason;
  std::optional<double> aie_grey;
  std::optional<double> aie_common_grey;  ///< on the pixels that all ok runs of this recording share
  std::optional<double> ate_rmse_m;
  std::optional<double> rpe_second_m;  ///< rmse over 1 s
  std::optional<double> rpe_second_rad;
  std::size_t tracked = 0;
  std::size_t total = 0;
  std::size_t vertices = 0;
  double fps = 0;
};

struct ResultTable {
  std::vector<TableRow> rows;       ///< by recording, then variant in the order of all_variants(), then run
  std::vector<std::string> notes;   ///< what a reader must know: reasons, runs left out of the common pixels
  std::vector<std::string> footer;  ///< the protocol of each column
};

/// Reads the intensity differences beside the records.
[[nodiscard]] ResultTable table_of(const std::vector<FoundRun>& runs);
/// Of a folder. Errors as find_runs().
[[nodiscard]] Result<ResultTable> collect_table(const std::filesystem::path& runs);

/// The heading and a line a row, as people see them: cm and degrees.
[[nodiscard]] std::vector<std::vector<std::string>> table_cells(const ResultTable& table);

enum class TableFormat { markdown, csv, json, latex };
/// Error usage.
[[nodiscard]] Result<TableFormat> parse_table_format(std::string_view text);

/// Markdown is aligned for a terminal; LaTeX uses booktabs; both show cm and degrees. CSV and JSON are SI
/// with an empty cell or null for what does not exist.
[[nodiscard]] std::string render_table(const ResultTable& table, TableFormat format);

}  // namespace fusebench
