#include "eval/compare/aggregate/effects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "eval/compare/aggregate/configurations.hpp"
#include "eval/record/run_files/option_order.hpp"

namespace fusebench::aggregate {

namespace {

double mean_of(std::vector<double> values, EffectMean mean) {
  if (mean == EffectMean::arithmetic) return ordered_mean(std::move(values));
  for (double& value : values) value = std::log(value);
  return std::exp(ordered_mean(std::move(values)));
}

/// A run with its ratio, which only ok runs have.
struct SweptRun {
  const RunRow* row = nullptr;
  std::optional<double> ratio;
};

std::optional<double> value_of(const RunRow& row, const registry::RunMetric& metric) {
  return row.status == record::RunStatus::ok ? row.numbers[metric] : std::nullopt;
}

EffectMean mean_for(std::span<const RunRow> rows, const registry::RunMetric& metric) {
  const bool positive = std::ranges::all_of(
      rows, [&](const RunRow& row) { return !row.attributable() || value_of(row, metric).value_or(1) > 0; });
  return positive ? EffectMean::geometric : EffectMean::arithmetic;
}

std::vector<SweptRun> swept_runs(std::span<const RunRow> rows, const registry::RunMetric& metric,
                                 EffectMean mean) {
  using Method = std::tuple<std::string, std::string_view, std::string_view>;
  const auto method_of = [](const RunRow& row) { return Method(row.recorded_part(), row.variant, row.imu); };
  std::map<Method, std::vector<double>> values;
  for (const RunRow& row : rows) {
    if (!row.attributable()) continue;
    if (const auto value = value_of(row, metric)) values[method_of(row)].push_back(*value);
  }
  std::map<Method, double> means;
  for (const auto& [key, of_key] : values) means[key] = mean_of(of_key, mean);
  std::vector<SweptRun> runs;
  for (const RunRow& row : rows) {
    if (!row.attributable()) continue;
    SweptRun run{&row, value_of(row, metric)};
    if (run.ratio) {
      const double of_all = means.at(method_of(row));
      run.ratio = of_all != 0 ? std::optional(*run.ratio / of_all) : std::nullopt;  // all are zero
    }
    runs.push_back(run);
  }
  return runs;
}

OptionEffect effect_of(const std::string& option, const std::vector<SweptRun>& runs, EffectMean mean) {
  struct Tally {
    EffectValue counts;
    std::vector<double> ratios;
  };
  std::map<std::string, Tally, run_files::OptionValueLess> tallies;
  for (const SweptRun& run : runs) {
    const std::string_view value = option_of(*run.row, option);
    auto at = tallies.find(value);
    if (at == tallies.end()) at = tallies.emplace(std::string(value), Tally{}).first;
    Tally& tally = at->second;
    ++tally.counts.n_total;
    tally.counts.n_lost += run.row->status == record::RunStatus::lost ? 1 : 0;
    tally.counts.n_failed += run.row->status == record::RunStatus::failed ? 1 : 0;
    if (run.ratio) tally.ratios.push_back(*run.ratio);
  }
  OptionEffect effect{option, {}};
  for (auto& [value, tally] : tallies) {
    tally.counts.value = value;
    tally.counts.n = tally.ratios.size();
    if (!tally.ratios.empty()) tally.counts.ratio = mean_of(std::move(tally.ratios), mean);
    effect.values.push_back(std::move(tally.counts));
  }
  return effect;
}

double beyond_main(double ratio, double first, double second, EffectMean mean) {
  // Arithmetic effects are around 1 each, so that independent ones add up to first + second - 1.
  return mean == EffectMean::geometric ? ratio / (first * second) : ratio - (first + second - 1) + 1;
}

std::map<std::string_view, std::size_t> places_of(const OptionEffect& effect) {
  std::map<std::string_view, std::size_t> places;
  for (const EffectValue& value : effect.values) places.emplace(value.value, places.size());
  return places;
}

std::vector<std::string> names_of(const OptionEffect& effect) {
  std::vector<std::string> names;
  for (const EffectValue& value : effect.values) names.push_back(value.value);
  return names;
}

OptionInteraction interaction_of(const OptionEffect& first, const OptionEffect& second,
                                 const std::vector<SweptRun>& runs, EffectMean mean) {
  OptionInteraction interaction{first.option, second.option, names_of(first), names_of(second), {}};
  const auto first_places = places_of(first);
  const auto second_places = places_of(second);
  std::vector<std::vector<double>> ratios(first.values.size() * second.values.size());
  for (const SweptRun& run : runs) {
    if (!run.ratio) continue;
    const std::size_t i = first_places.at(option_of(*run.row, first.option));
    const std::size_t j = second_places.at(option_of(*run.row, second.option));
    ratios[i * second.values.size() + j].push_back(*run.ratio);
  }
  for (std::size_t i = 0; i < first.values.size(); ++i) {
    auto& line = interaction.cells.emplace_back();
    for (std::size_t j = 0; j < second.values.size(); ++j) {
      InteractionCell& cell = line.emplace_back();
      std::vector<double>& of_cell = ratios[i * second.values.size() + j];
      cell.n = of_cell.size();
      if (of_cell.empty()) continue;
      cell.ratio = mean_of(std::move(of_cell), mean);
      // Both exist: the runs of the cell are among theirs.
      cell.beyond_main = beyond_main(*cell.ratio, *first.values[i].ratio, *second.values[j].ratio, mean);
    }
  }
  return interaction;
}

}  // namespace

std::string_view to_string(EffectMean mean) {
  return mean == EffectMean::geometric ? "geometric" : "arithmetic";
}

SweepEffects sweep_effects(std::span<const RunRow> rows, const registry::RunMetric& metric) {
  SweepEffects effects{&metric, mean_for(rows, metric), {}, {}};
  const std::vector<SweptRun> runs = swept_runs(rows, metric, effects.mean);
  for (const std::string& option : edited_options(rows)) {
    OptionEffect effect = effect_of(option, runs, effects.mean);
    if (effect.values.size() >= 2) effects.options.push_back(std::move(effect));
  }
  for (std::size_t i = 0; i < effects.options.size(); ++i) {
    for (std::size_t j = i + 1; j < effects.options.size(); ++j) {
      effects.interactions.push_back(
          interaction_of(effects.options[i], effects.options[j], runs, effects.mean));
    }
  }
  return effects;
}

}  // namespace fusebench::aggregate
