#include "eval/record/registry/run_numbers.hpp"

#include <cmath>
#include <string_view>

namespace fusebench::registry {

void RunNumbers::set(const RunMetric& metric, std::optional<double> value) {
  const bool exists = value && std::isfinite(*value);
  values_[index_of(metric)] = exists ? *value : std::numeric_limits<double>::quiet_NaN();
}

void RunNumbers::derive() {
  if ((*this)["frames_total"] == 0) {  // the run did not begin
    for (const std::string_view key : {"frames_total", "frames_tracked", "frames_lost",
                                       "frames_other_segments", "segments", "segments_joined"})
      set(run_metric(key), std::nullopt);
  }
  if ((*this)["model_vertices"] == 0) set(run_metric("model_vertices"), std::nullopt);
  for (const RunMetric& metric : run_metrics()) {
    if (metric.from != nullptr) set(metric, metric.from(*this));
  }
}

RunNumbers numbers_of(const record::RunRecord& record) {
  RunNumbers numbers;
  for (const RunMetric& metric : run_metrics()) {
    if (metric.of != nullptr) numbers.set(metric, metric.of(record).value);
  }
  numbers.derive();
  return numbers;
}

record::Outcome<double> number_of(const record::RunRecord& record, const RunMetric& metric) {
  if (metric.of != nullptr) return metric.of(record);
  const std::optional<double> value = numbers_of(record)[metric];
  if (value) return {value, {}};
  return {std::nullopt, "the numbers that it is computed from are absent"};
}

}  // namespace fusebench::registry
