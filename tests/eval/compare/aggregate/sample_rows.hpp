// Rows of runs as a sweep would give them.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::testing {

/// An ok run with a position error and a time for each frame.
inline aggregate::RunRow sample_row(std::string recording, aggregate::RunOptions options, double ate_m,
                                    double cpu_ms_per_frame = 10, std::string variant = "full") {
  aggregate::RunRow row;
  row.recording = std::move(recording);
  row.fingerprint = "00";
  row.variant = std::move(variant);
  row.truth = "given";
  row.options = std::move(options);
  row.status = record::RunStatus::ok;
  row.total = row.tracked = 100;
  row.numbers.set(registry::run_metric("ate_rmse_m"), ate_m);
  row.numbers.set(registry::run_metric("cpu_ms_per_frame"), cpu_ms_per_frame);
  return row;
}

/// The same without numbers.
inline aggregate::RunRow sample_bad_row(std::string recording, aggregate::RunOptions options,
                                        record::RunStatus status) {
  aggregate::RunRow row = sample_row(std::move(recording), std::move(options), 0);
  row.numbers = {};
  row.status = status;
  row.reason = "lost at frame 12";
  return row;
}

inline std::vector<aggregate::RunRow> shuffled(std::vector<aggregate::RunRow> rows, unsigned seed) {
  std::mt19937 random(seed);
  std::shuffle(rows.begin(), rows.end(), random);
  return rows;
}

/// By its word.
inline const registry::RunMetric& metric_of(const char* word) {
  return *registry::find_ranking_metric(word).value();
}

}  // namespace fusebench::testing
