// What each option of a parameter sweep does to a metric, alone and in pairs.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::aggregate {

enum class EffectMean {
  geometric,   ///< where all values are positive: effects are factors
  arithmetic,  ///< otherwise
};
[[nodiscard]] std::string_view to_string(EffectMean mean);

/// Of the runs with one value of an option.
struct EffectValue {
  std::string value;  ///< or kUnsetOption
  /// Mean of the runs' ratios to the mean of their recording and variant; 1: as good as the average.
  std::optional<double> ratio;
  std::size_t n = 0;  ///< ok runs that the ratio is of
  std::size_t n_total = 0;
  std::size_t n_lost = 0;
  std::size_t n_failed = 0;
};

struct OptionEffect {
  std::string option;
  std::vector<EffectValue> values;  ///< numbers by value, then texts
};

struct InteractionCell {
  std::optional<double> ratio;  ///< as EffectValue::ratio
  /// What is left beyond both main effects: 1 where they act independently. A quotient of factors with the
  /// geometric mean, with the arithmetic one a difference, plus 1.
  std::optional<double> beyond_main;
  std::size_t n = 0;
};

/// The grid of a heat map.
struct OptionInteraction {
  std::string first;
  std::string second;
  std::vector<std::string> first_values;
  std::vector<std::string> second_values;
  std::vector<std::vector<InteractionCell>> cells;  ///< [first][second]
};

struct SweepEffects {
  const registry::RunMetric* metric = nullptr;
  EffectMean mean = EffectMean::geometric;
  std::vector<OptionEffect> options;            ///< those that have two values or more, by key
  std::vector<OptionInteraction> interactions;  ///< of each pair of them
};

/// Runs of which the configuration is not known are left out. Ratios are to the mean of the ok runs of the
/// same recording and variant, so that recordings of different difficulty compare. A ratio is free of the
/// other options only if each value saw the same values of those: with runs that are lost, read it beside
/// their share. Does not depend on the order of the runs.
[[nodiscard]] SweepEffects sweep_effects(std::span<const RunRow> rows, const registry::RunMetric& metric);

}  // namespace fusebench::aggregate
