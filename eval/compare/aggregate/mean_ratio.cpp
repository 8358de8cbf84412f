#include "eval/compare/aggregate/mean_ratio.hpp"

#include <cmath>

namespace fusebench::aggregate {

namespace {

/// 0.975 quantile of Student's t.
double student_quantile(std::size_t freedom) {
  constexpr std::array<double, 10> kQuantiles = {12.706, 4.303, 3.182, 2.776, 2.571,
                                                 2.447,  2.365, 2.306, 2.262, 2.228};
  if (freedom <= kQuantiles.size()) return kQuantiles[freedom - 1];
  // Cornish & Fisher's expansion around the normal quantile, to a thousandth from here on.
  constexpr double z = 1.959964;
  const auto n = static_cast<double>(freedom);
  return z + (z * z * z + z) / (4 * n) + (5 * std::pow(z, 5) + 16 * z * z * z + 3 * z) / (96 * n * n);
}

}  // namespace

MeanRatio mean_ratio(std::span<const double> logarithms) {
  MeanRatio result;
  result.count = logarithms.size();
  if (logarithms.empty()) return result;
  const auto count = static_cast<double>(logarithms.size());
  double mean = 0;
  for (const double value : logarithms) mean += value / count;
  result.ratio = std::exp(mean);
  if (logarithms.size() < 2) return result;
  double squares = 0;
  for (const double value : logarithms) squares += (value - mean) * (value - mean);
  const double error = std::sqrt(squares / (count - 1) / count);
  const double reach = student_quantile(logarithms.size() - 1) * error;
  result.interval = {std::exp(mean - reach), std::exp(mean + reach)};
  return result;
}

}  // namespace fusebench::aggregate
