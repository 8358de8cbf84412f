// Which configuration is best, by how much, and whether that is more than noise.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/compare/aggregate/ratio_means.hpp"
#include "eval/compare/tables/table.hpp"
#include "eval/record/registry/run_metric.hpp"
#include "eval/record/run_files/found_runs.hpp"

namespace fusebench::findings {

/// A variant with the options that not all runs share, and the IMU where its runs had different ones.
struct RankedConfiguration {
  std::string label;
  std::string variant;
  std::string description;             ///< in a line
  std::vector<std::size_t> rows = {};  ///< of the table: its repetitions on all recordings
  std::size_t runs = 0;
  std::size_t ok = 0;
  std::size_t recordings = 0;   ///< of those that it has a number of
  std::optional<double> value;  ///< SI, geometric mean; absent where it lacks a number that others have
  aggregate::RatioMean mean;    ///< to the smallest number of each recording
  std::size_t tracked = 0;      ///< frames of the runs that have a number, of `frames`
  std::size_t frames = 0;
  bool contradicts_truth = false;  ///< any of these runs: record::noted_contradiction()

  [[nodiscard]] double tracked_share() const {
    return frames == 0 ? 0.0 : static_cast<double>(tracked) / static_cast<double>(frames);
  }
};

/// Over data of one kind, which alone can be compared: runs with an IMU made from the ground truth are apart.
struct Ranking {
  std::string data;  ///< "recorded", "simulated"
  bool synthetic_imu = false;
  /// "frames 0:100" of runs over that part of each recording, "with parts of recordings" where windows
  /// differ; empty: over whole recordings.
  std::string frames;
  const registry::RunMetric* metric = nullptr;
  std::size_t recordings = 0;  ///< or windows of them, of which any configuration has a number
  /// Those with all numbers first; of these, those that tie with the best; then by the mean ratio.
  std::vector<RankedConfiguration> configurations;

  /// ", synthetic IMU, frames 0:100" of what it has; for the end of a title or of a list of recordings.
  [[nodiscard]] std::string restrictions() const {
    return (synthetic_imu ? ", synthetic IMU" : "") + (frames.empty() ? "" : ", " + frames);
  }
  /// `data` in a sentence: "real", "simulated".
  [[nodiscard]] std::string data_word() const { return data == "recorded" ? "real" : data; }
};

/// By ATE, or by AIE on common pixels where there is no ATE, or by AIE where there is one configuration and
/// neither; a configuration's number of a recording is the mean over its runs that are ok. One a kind of data
/// and of IMU that has a number, and a window of those that share frames. table: of these runs.
[[nodiscard]] std::vector<Ranking> rankings_of(std::span<const run_files::FoundRun> runs,
                                               const tables::ResultTable& table);

}  // namespace fusebench::findings
