#include "eval/metrics/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fusebench::metrics {

Statistics statistics(std::span<const double> values) {
  Statistics result;
  result.count = values.size();
  if (values.empty()) return result;
  const double count = static_cast<double>(values.size());

  double sum = 0;
  result.sse = 0;
  for (const double value : values) {
    sum += value;
    result.sse += value * value;
  }
  result.mean = sum / count;
  result.rmse = std::sqrt(result.sse / count);

  // A second pass: sse / n - mean^2 would cancel.
  double squares = 0;
  for (const double value : values) squares += (value - result.mean) * (value - result.mean);
  result.std = std::sqrt(squares / count);

  const auto [smallest, largest] = std::ranges::minmax_element(values);
  result.min = *smallest;
  result.max = *largest;
  std::vector<double> halves(values.begin(), values.end());
  const auto middle = halves.begin() + static_cast<std::ptrdiff_t>(halves.size() / 2);
  std::ranges::nth_element(halves, middle);
  result.median =
      halves.size() % 2 == 1 ? *middle : 0.5 * (*std::max_element(halves.begin(), middle) + *middle);
  return result;
}

}  // namespace fusebench::metrics
