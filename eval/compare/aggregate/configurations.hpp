// Runs put together by configuration: a variant, the options that were edited, and the IMU that it had.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/compare/aggregate/ratio_means.hpp"
#include "eval/compare/aggregate/run_rows.hpp"
#include "eval/record/registry/replicated_numbers.hpp"

namespace fusebench::aggregate {

struct ConfigurationSummary {
  std::string variant;
  RunOptions options;
  std::string imu;  ///< of RunRow
  /// Mean over recordings of the median over their ok runs; absent without any.
  std::optional<double> mean;
  /// Of that mean from replicate to replicate; the mean alone where a recording has no replicates.
  std::optional<registry::MedianRange> spread = {};
  RatioMean ratio = {};                     ///< to the best of each measured recording
  std::size_t n_ok = 0;                     ///< runs that are ok and have the number
  std::size_t n_total = 0;                  ///< runs on the measured recordings
  std::vector<std::string> failed;          ///< recordings on which a run failed or was lost
  std::vector<std::string> without_number;  ///< recordings with an ok run that does not have it
  std::vector<std::string> not_run;         ///< recordings without a run

  /// Whether the mean is over every measured recording and run.
  [[nodiscard]] bool complete() const {
    return mean && failed.empty() && without_number.empty() && not_run.empty();
  }
};

/// Recordings are here those of RunRow::recorded_part().
struct ConfigurationSummaries {
  std::vector<std::string> recordings;  ///< that are measured
  /// Recordings that have ok runs, none of which has the number (no ground truth, say): left out.
  std::vector<std::string> without_number;
  /// By variant in the order of all_variants(), options, IMU.
  std::vector<ConfigurationSummary> configurations;
};

/// Runs whose configuration is not known are left out. Does not depend on the order of the runs.
[[nodiscard]] ConfigurationSummaries summarise_configurations(std::span<const RunRow* const> runs,
                                                              const registry::RunMetric& metric);

enum class KindsBy { data, data_and_imu };
/// What kind of data each recording is of, as one word: means never mix recorded with simulated data, an
/// independent truth with a pseudo one, or recordings whose IMU is synthetic with those that have a sensor
/// ("recorded, IMUs synthetic": where a configuration uses one). Of one recording the latter does not matter,
/// since runs with different IMUs are different configurations.
[[nodiscard]] std::map<std::string, std::string> recording_kinds(std::span<const RunRow> rows,
                                                                 KindsBy by = KindsBy::data_and_imu);

/// Added in the order of size, so that the sum does not depend on the order of the values. Not of none.
[[nodiscard]] double ordered_mean(std::vector<double> values);

}  // namespace fusebench::aggregate
