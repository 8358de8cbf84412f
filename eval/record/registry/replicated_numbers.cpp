#include "eval/record/registry/replicated_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fusebench::registry {

std::optional<MedianRange> median_range(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return MedianRange{median, values.front(), values.back()};
}

std::optional<MedianRange> median_range(std::span<const RunNumbers> runs, const RunMetric& metric) {
  std::vector<double> values;
  for (const RunNumbers& run : runs) {
    if (const auto value = run[metric]) values.push_back(*value);
  }
  return median_range(std::move(values));
}

RunNumbers medians_of(std::span<const RunNumbers> runs) {
  RunNumbers medians;
  for (const RunMetric& metric : run_metrics()) {
    const bool all =
        std::ranges::all_of(runs, [&](const RunNumbers& run) { return run[metric].has_value(); });
    if (const auto value = median_range(runs, metric); value && all) medians.set(metric, value->median);
  }
  return medians;
}

std::string shown_text(const RunMetric& metric, const std::optional<MedianRange>& value) {
  if (!value) return "-";
  const std::string least = shown_text(metric, value->least);
  const std::string most = shown_text(metric, value->most);
  const std::string median = shown_text(metric, value->median);
  return least == most ? median : fmt::format("{} [{}, {}]", median, least, most);
}

std::optional<double> sensitivity_of(std::span<const RunNumbers> runs) {
  if (runs.size() < 2) return std::nullopt;
  const auto ate = median_range(runs, run_metric("ate_rmse_m"));
  if (!ate || !(ate->median > 0)) return std::nullopt;
  return (ate->most - ate->least) / ate->median;
}

}  // namespace fusebench::registry
