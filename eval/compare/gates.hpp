// How much a number may change before a comparison fails, as data.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/metric_values.hpp"

namespace fusebench::compare {

/// A change up to the larger of absolute and relative * |base| is none.
struct MetricTolerance {
  double relative = 0;
  double absolute = 0;  ///< in the metric's unit
  registry::Better better = registry::Better::smaller;
};

/// Other limits for some runs. An empty list means all of them; of metrics: all that are no counts.
struct GateOverride {
  std::vector<std::string> recordings;  ///< names, or beginnings that end with *
  std::vector<std::string> variants;    ///< the same
  std::vector<std::string> metrics;     ///< keys of gated_metrics() and gated_costs()
  std::optional<double> relative;
  std::optional<double> absolute;
  std::optional<double> factor;
  std::string place;  ///< "file:line"

  [[nodiscard]] bool is_for(std::string_view recording, std::string_view variant) const;
};

/// Starts with the values of configs/gates.toml.
struct Gates {
  bool improvements_fail = true;         ///< a baseline that is too bad hides what gets worse later
  bool changed_defaults_fail = true;     ///< options that nobody set and that are not what they were
  bool changed_simulation_fails = true;  ///< a simulated recording of as many frames that has other bytes
  bool repetitions_fail = true;          ///< repetitions of one side that are not the same
  bool divergence_fails = false;         ///< a trajectory that differs while every number keeps its tolerance
  std::vector<MetricTolerance> tolerances;  ///< of gated_metrics(), in their order
  std::vector<double> factors;              ///< of gated_costs(), in their order
  double alpha = 0.01;                      ///< a slower run fails where the rank test's p is below
  std::size_t min_repetitions = 5;          ///< on both sides, for times and memory to be gated
  std::vector<GateOverride> overrides;      ///< later ones win

  Gates();
  /// metric: index into gated_metrics().
  [[nodiscard]] MetricTolerance tolerance(std::size_t metric, std::string_view recording,
                                          std::string_view variant) const;
  /// quantity: index into gated_costs().
  [[nodiscard]] double factor(std::size_t quantity, std::string_view recording,
                              std::string_view variant) const;
};

/// Strict. Errors: data_missing; configuration with file:line, for an unknown key or metric (with the nearest
/// one), a wrong type, a number out of range, and an alpha that so few repetitions cannot reach.
[[nodiscard]] Result<Gates> read_gates(const std::filesystem::path& file);

/// The same of a text; `name` stands for the file in messages.
[[nodiscard]] Result<Gates> parse_gates(std::string_view text, const std::string& name);

}  // namespace fusebench::compare
