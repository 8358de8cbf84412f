// The table of a folder of runs: one row per run, failed and lost ones included.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/tables/latex_table.hpp"
#include "eval/record/record.hpp"
#include "eval/record/registry/replicated_numbers.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::tables {

/// Errors of a run that tracked less than this share of the frames of another run are of an easier part of
/// the recording.
inline constexpr double kLeastCoverage = 0.9;

/// One run, or the replicates of one, with the identity of the first.
struct TableRow : run_files::RunIdentity {
  std::vector<std::size_t> members = {};              ///< indices of its runs
  registry::RunNumbers numbers;                       ///< of replicates: medians over those that are ok
  std::vector<registry::RunNumbers> replicates = {};  ///< of each that is ok, where there are several
  std::size_t ok_members = 0;                         ///< of `members`
  std::string label;        ///< the variant, with what distinguishes the run from others (RunSet::labels())
  std::string window = {};  ///< "frames 0:100" of a run over a part of the recording
  record::RunStatus status =
      record::RunStatus::failed;  ///< of the first replicate that is not ok, if there is one
  std::string reason;
  std::optional<std::size_t> silent;  ///< undetected failures; absent without truth
  std::size_t tracked = 0;
  std::size_t total = 0;
  bool contradicts_truth = false;  ///< record::noted_contradiction()

  [[nodiscard]] double tracked_share() const {
    return total == 0 ? 0.0 : static_cast<double>(tracked) / static_cast<double>(total);
  }
  /// "desk" or "desk frames 0:100".
  [[nodiscard]] std::string recorded_part() const {
    return window.empty() ? recording : recording + " " + window;
  }
};

/// Of the runs of a variant with the same options on data of one kind.
struct TableMean {
  std::string data;
  std::string imu;
  std::string truth;
  std::string variant;
  std::string label;           ///< the variant, with the edits that not all runs share
  std::size_t recordings = 0;  ///< different ones
  std::size_t ok = 0;
  std::size_t total = 0;
  std::size_t silent = 0;  ///< runs with undetected failures among the ok ones
  registry::RunNumbers
      values;               ///< of columns, each over all ok runs; absent where one of them does not have it
  std::size_t windows = 0;  ///< different stretches of frames of these recordings, together
};

struct ResultTable {
  std::vector<TableRow> rows;  ///< by recording, then variant in the order of all_variants(), then run; a row
                               ///< for all replicates of a run
  std::vector<TableMean> means;     ///< where there are several recordings; of one variant after the other
  std::vector<std::string> notes;   ///< what a reader must know: reasons, runs left out of the common pixels
  std::vector<std::string> footer;  ///< the protocol of each column
};

/// Whether any row is over several replicates.
[[nodiscard]] bool has_replicates(const ResultTable& table);

/// Reads the intensity differences beside the records.
[[nodiscard]] ResultTable table_of(const std::vector<run_files::FoundRun>& runs);

/// The heading, a line a row and then a line a mean, as people see them: cm and degrees.
[[nodiscard]] std::vector<std::vector<std::string>> table_cells(const ResultTable& table);

/// A row's number as people see it, with its range over replicates.
[[nodiscard]] std::string shown_value(const registry::RunMetric& metric, const TableRow& row);

/// A number of a metric as people see it; "-" of what does not exist.
[[nodiscard]] std::string shown_value(const registry::RunMetric& metric, const std::optional<double>& value);

/// The places of the cells in which a run is the best of its recording's ok runs over the same frames, if
/// there are others; all that are shown as the best one is are best.
[[nodiscard]] std::vector<std::size_t> best_cells(const ResultTable& table, const TableRow& row);

/// Error usage: a key that is no column of the table of runs, with those that are.
[[nodiscard]] Result<void> check_latex_metrics(const std::vector<std::string>& keys);

enum class TableFormat { markdown, csv, csv_long, json, latex };
/// Error usage.
[[nodiscard]] Result<TableFormat> parse_table_format(std::string_view text);

/// Markdown is aligned for a terminal; LaTeX uses booktabs and has the best of each recording in bold; both
/// show cm and degrees. CSV and JSON are SI with an empty cell or null for what does not exist; csv_long has
/// a line for each number of each run, and leaves out what does not exist.
/// layout: of LaTeX. width: of a line of Markdown, as text::markdown_table() has it.
[[nodiscard]] std::string render_table(const ResultTable& table, TableFormat format,
                                       const LatexLayout& layout = {}, std::size_t width = 0);

}  // namespace fusebench::tables
