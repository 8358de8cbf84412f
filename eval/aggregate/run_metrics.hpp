// The numbers of a run that aggregations know, by name.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"

namespace fusebench::aggregate {

/// Numbers that do not exist are absent, never 0 or NaN.
struct RunNumbers {
  std::optional<double> ate_rmse_m;
  std::optional<double> rpe_frame_m;   ///< rmse over one frame
  std::optional<double> rpe_second_m;  ///< rmse over one second
  std::optional<double> rpe_second_rad;
  std::optional<double> aie_grey;
  std::optional<double> mesh_accuracy_m;  ///< mean, aligned by all poses
  std::optional<double> mesh_completeness_m;
  std::optional<double> silent_failures;  ///< frames
  std::optional<double> cpu_s;
  std::optional<double> wall_s;
  std::optional<double> peak_rss_bytes;
  std::optional<double> fps;
  std::optional<double> cpu_ms_per_frame;  ///< of the frames that were processed
};

/// What is known of each of them.
struct RunMetric {
  std::string_view key;      ///< of CSV and JSON
  std::string_view word;     ///< short name on the command line; empty: the key alone
  std::string_view unit;     ///< of the number
  std::string_view heading;  ///< of tables for people, with the unit that they show
  double shown_factor = 1;
  int decimals = 2;
  bool timing = false;         ///< never the same twice
  bool less_is_better = true;  ///< and can therefore be ranked
  std::optional<double> RunNumbers::*value = nullptr;
};

/// All of them, those that depend on the inputs alone first.
[[nodiscard]] std::span<const RunMetric> run_metrics();

/// By word or key, of those that can be ranked; valid for ever. Error usage, with the allowed words.
[[nodiscard]] Result<const RunMetric*> find_run_metric(std::string_view name);

}  // namespace fusebench::aggregate
