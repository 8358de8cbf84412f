#include "eval/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fusebench {

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

  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  result.median = sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
  result.min = sorted.front();
  result.max = sorted.back();
  return result;
}

}  // namespace fusebench
