#include "eval/report/sweep_charts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "eval/record/run_files/option_order.hpp"

namespace fusebench::report {

namespace {

constexpr std::size_t kMostCurves = 8;

/// Where the values of an option are on an axis: at their numbers, or one after the other.
struct ValueAxis {
  std::vector<double> places;
  bool numeric = false;
};

ValueAxis axis_of(const std::vector<std::string>& values) {
  ValueAxis axis;
  axis.numeric =
      std::ranges::all_of(values, [](const auto& v) { return run_files::option_number(v).has_value(); });
  for (std::size_t i = 0; i < values.size(); ++i)
    axis.places.push_back(axis.numeric ? *run_files::option_number(values[i]) : static_cast<double>(i));
  return axis;
}

std::vector<std::string> values_of(const aggregate::OptionEffect& effect) {
  std::vector<std::string> values;
  for (const aggregate::EffectValue& value : effect.values) values.push_back(value.value);
  return values;
}

std::string mean_sentence(const aggregate::SweepEffects& effects) {
  return fmt::format(
      "{} mean over runs of the ratio to the {} mean of all ok runs of the same recording and variant; 1 is "
      "as "
      "good as the average, less is better.",
      effects.mean == aggregate::EffectMean::geometric ? "Geometric" : "Arithmetic",
      aggregate::to_string(effects.mean));
}

/// A curve over numbers, a bar for each text.
void set_axis(const aggregate::OptionEffect& effect, const ValueAxis& axis, page::Chart& chart) {
  chart.x_label = effect.option;
  if (!axis.numeric) chart.categories = values_of(effect);
  for (page::ChartSeries& series : chart.series)
    series.style = axis.numeric ? page::SeriesStyle::line : page::SeriesStyle::bars;
}

page::Chart effect_chart(const aggregate::SweepEffects& effects, const aggregate::OptionEffect& effect) {
  const ValueAxis axis = axis_of(values_of(effect));
  page::Chart chart;
  chart.title = fmt::format("{}: {}", effect.option, effects.metric->key);
  chart.caption = mean_sentence(effects) + " Runs:";
  chart.left_label = fmt::format("{}, ratio", effects.metric->key);
  chart.from_zero = !axis.numeric;  // bars stand on something
  page::ChartSeries series{"ratio", {}};
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    const aggregate::EffectValue& value = effect.values[i];
    chart.caption += fmt::format(" {} of {} at {}{}", value.n, value.n_total, value.value,
                                 i + 1 < effect.values.size() ? "," : ".");
    if (value.ratio) series.points.emplace_back(axis.places[i], *value.ratio);
  }
  chart.series.push_back(std::move(series));
  set_axis(effect, axis, chart);
  return chart;
}

std::optional<page::Chart> not_ok_chart(const aggregate::OptionEffect& effect) {
  const ValueAxis axis = axis_of(values_of(effect));
  page::Chart chart;
  chart.title = fmt::format("{}: lost and failed runs", effect.option);
  chart.left_label = "share of runs [%]";
  page::ChartSeries lost{"lost", {}};
  page::ChartSeries failed{"failed", {}};
  bool any = false;
  for (std::size_t i = 0; i < effect.values.size(); ++i) {
    const aggregate::EffectValue& value = effect.values[i];
    const double percent = 100 / static_cast<double>(std::max<std::size_t>(value.n_total, 1));
    lost.points.emplace_back(axis.places[i], percent * static_cast<double>(value.n_lost));
    failed.points.emplace_back(axis.places[i], percent * static_cast<double>(value.n_failed));
    any = any || value.n_lost + value.n_failed > 0;
  }
  if (!any) return std::nullopt;
  chart.series = {std::move(lost), std::move(failed)};
  set_axis(effect, axis, chart);
  return chart;
}

/// With the option of more values along the axis, so that there are few curves.
aggregate::OptionInteraction with_few_curves(const aggregate::OptionInteraction& given) {
  if (given.second_values.size() <= given.first_values.size()) return given;
  aggregate::OptionInteraction turned{given.second, given.first, given.second_values, given.first_values, {}};
  for (std::size_t i = 0; i < turned.first_values.size(); ++i) {
    auto& line = turned.cells.emplace_back();
    for (std::size_t j = 0; j < turned.second_values.size(); ++j) line.push_back(given.cells[j][i]);
  }
  return turned;
}

/// At most kMostCurves of so many, the first and the last among them.
std::vector<std::size_t> curves_of(std::size_t count) {
  const std::size_t most = std::min(count, kMostCurves);
  std::vector<std::size_t> curves;
  for (std::size_t k = 0; k < most; ++k) curves.push_back(most == 1 ? 0 : k * (count - 1) / (most - 1));
  return curves;
}

page::Chart interaction_chart(const aggregate::SweepEffects& effects,
                              const aggregate::OptionInteraction& given) {
  const aggregate::OptionInteraction interaction = with_few_curves(given);
  const ValueAxis axis = axis_of(interaction.first_values);
  page::Chart chart;
  chart.title = fmt::format("{} and {}: {}", interaction.first, interaction.second, effects.metric->key);
  chart.caption = mean_sentence(effects) + " Curves of the same course do not interact.";
  chart.x_label = interaction.first;
  chart.left_label = fmt::format("{}, ratio", effects.metric->key);
  chart.from_zero = false;
  if (!axis.numeric) {  // categories would make bars that stand on one another
    chart.caption += " Along the axis:";
    for (std::size_t i = 0; i < interaction.first_values.size(); ++i)
      chart.caption += fmt::format("{} {} = {}", i == 0 ? "" : ",", i, interaction.first_values[i]);
    chart.caption += ".";
  }
  const std::vector<std::size_t> curves = curves_of(interaction.second_values.size());
  if (curves.size() < interaction.second_values.size()) {
    chart.caption += fmt::format(" {} of {} values of {}.", curves.size(), interaction.second_values.size(),
                                 interaction.second);
  }
  for (const std::size_t j : curves) {
    page::ChartSeries series{fmt::format("{} = {}", interaction.second, interaction.second_values[j]), {}};
    for (std::size_t i = 0; i < interaction.first_values.size(); ++i) {
      if (const auto& ratio = interaction.cells[i][j].ratio)
        series.points.emplace_back(axis.places[i], *ratio);
    }
    if (!series.points.empty()) chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace

std::vector<page::Chart> effect_charts(const aggregate::SweepEffects& effects) {
  std::vector<page::Chart> charts;
  for (const aggregate::OptionEffect& effect : effects.options) {
    page::Chart chart = effect_chart(effects, effect);
    if (!chart.series.front().points.empty()) charts.push_back(std::move(chart));
    if (auto not_ok = not_ok_chart(effect)) charts.push_back(std::move(*not_ok));
  }
  return charts;
}

std::vector<page::Chart> interaction_charts(const aggregate::SweepEffects& effects) {
  std::vector<page::Chart> charts;
  for (const aggregate::OptionInteraction& interaction : effects.interactions) {
    page::Chart chart = interaction_chart(effects, interaction);
    const auto is_curve = [](const page::ChartSeries& series) { return series.points.size() > 1; };
    if (std::ranges::any_of(chart.series, is_curve)) charts.push_back(std::move(chart));
  }
  return charts;
}

page::Chart pareto_chart(const aggregate::ParetoFront& front) {
  page::Chart chart;
  chart.title = fmt::format("{} against time", front.metric->key);
  chart.caption = fmt::format(
      "Means over {} recording{}. On the front no other configuration is both better and cheaper. Left out, "
      "since they lost, failed or did not run some recordings: {}.",
      front.recordings.size(), front.recordings.size() == 1 ? "" : "s", front.left_out);
  chart.x_label = "CPU [ms/frame]";
  chart.left_label = std::string(front.metric->heading);
  page::ChartSeries line{"Pareto front", {}};
  page::ChartSeries dots{"configurations", {}, page::SeriesStyle::dots};
  for (const aggregate::ParetoPoint& point : front.points) {
    const Vector2d place(point.cpu_ms_per_frame, front.metric->shown_factor * point.value);
    dots.points.push_back(place);
    if (point.on_front) line.points.push_back(place);
  }
  chart.series = {std::move(line), std::move(dots)};
  return chart;
}

}  // namespace fusebench::report
