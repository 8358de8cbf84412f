// What aggregations keep of each run of a folder with tens of thousands of them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "eval/record/record.hpp"
#include "eval/record/registry/run_numbers.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::aggregate {

/// Key and value text of the options that somebody edited, beyond what the variant says; by key.
using run_files::RunOptions;

/// What stands in place of the value of an option that a run does not edit.
inline constexpr std::string_view kUnsetOption = "unset";

/// One run, without what no aggregation needs. `imu` is empty where it is unknown.
struct RunRow : run_files::RunIdentity {
  registry::RunNumbers numbers;
  std::string label;   ///< the variant with what distinguishes the run from others (RunSet::labels())
  std::string window;  ///< "frames 0:100" of a run over a part of the recording
  std::string folder;  ///< relative to the root, with "/"
  record::RunStatus status = record::RunStatus::failed;
  std::string reason;  ///< empty if ok
  std::size_t total = 0;
  std::size_t tracked = 0;
  std::size_t lost = 0;
  bool readable = true;  ///< false: the record or a file is damaged; `reason` says how
  /// False for a run that failed before it wrote its options, where no other run has the same configuration.
  bool options_known = true;

  /// Whether it is known which configuration the run is of.
  [[nodiscard]] bool attributable() const { return readable && options_known; }
  /// What means count once: numbers over different frames of a recording are never averaged as if they were
  /// of the same.
  [[nodiscard]] std::string recorded_part() const {
    return window.empty() ? recording : recording + " " + window;
  }
};

/// Fills `label` and `window` of all rows, and `imu` of those that did not open their recording.
void set_labels(std::vector<RunRow>& rows);

/// The value of an option, or kUnsetOption.
[[nodiscard]] std::string_view option_of(const RunRow& row, std::string_view key);

/// Keys of all options that any run edits, sorted.
[[nodiscard]] std::vector<std::string> edited_options(std::span<const RunRow> rows);

[[nodiscard]] std::size_t unreadable_count(std::span<const RunRow> rows);

/// Every run below `root` as record_files() finds them, by recording, variant in the order of all_variants(),
/// options, run; the same for any number of threads. A run that is not whole is a failed row with the reason.
/// A failed run that never wrote its options has those of a run of the same variant and configuration hash.
/// Error data_missing: no folder, or no records at all.
[[nodiscard]] Result<std::vector<RunRow>> read_run_rows(const std::filesystem::path& root,
                                                        const Workers& workers);

}  // namespace fusebench::aggregate
