#include "eval/compare/metric_values.hpp"

#include <fmt/format.h>

#include <vector>

namespace fusebench::compare {

namespace {

std::vector<const registry::RunMetric*> with_tolerance(bool costs) {
  std::vector<const registry::RunMetric*> metrics;
  for (const registry::RunMetric& metric : registry::run_metrics()) {
    if (metric.tolerance && (metric.kind == registry::MetricKind::cost) == costs) metrics.push_back(&metric);
  }
  return metrics;
}

}  // namespace

std::span<const registry::RunMetric* const> gated_metrics() {
  static const std::vector<const registry::RunMetric*> kMetrics = with_tolerance(false);
  return kMetrics;
}

std::span<const registry::RunMetric* const> gated_costs() {
  static const std::vector<const registry::RunMetric*> kCosts = with_tolerance(true);
  return kCosts;
}

std::string quantity_text(double value, std::string_view unit) {
  return unit == "1" ? fmt::format("{:.6g}", value) : fmt::format("{:.6g} {}", value, unit);
}

}  // namespace fusebench::compare
