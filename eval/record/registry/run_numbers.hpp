// The numbers of one run, by metric.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>

#include "eval/record/registry/run_metric.hpp"

namespace fusebench::registry {

inline constexpr std::size_t kMetricCount = 52;  ///< rows of run_metrics()

/// A number that does not exist is absent, never 0 or NaN.
class RunNumbers {
 public:
  RunNumbers() { values_.fill(std::numeric_limits<double>::quiet_NaN()); }

  [[nodiscard]] std::optional<double> operator[](const RunMetric& metric) const {
    const double value = values_[index_of(metric)];
    return value == value ? std::optional(value) : std::nullopt;
  }
  [[nodiscard]] std::optional<double> operator[](std::string_view key) const {
    return (*this)[run_metric(key)];
  }
  /// A value that is not finite is none.
  void set(const RunMetric& metric, std::optional<double> value);

  /// Sets those that come from others of them.
  void derive();

 private:
  std::array<double, kMetricCount> values_;
};

/// All numbers of a record but those that take several runs.
[[nodiscard]] RunNumbers numbers_of(const record::RunRecord& record);

/// One number of a record, or why there is none.
[[nodiscard]] record::Outcome<double> number_of(const record::RunRecord& record, const RunMetric& metric);

}  // namespace fusebench::registry
