#include "datasets/simulator/random/random_numbers.hpp"

#include <cmath>

namespace fusebench::simulator::random {

namespace {

/// Quantile of the standard normal distribution, by bisection.
double normal_quantile(double probability) {
  double low = -9;
  double high = 9;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(-middle / std::sqrt(2.0)) < probability ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

NormalTable::NormalTable() {
  const std::size_t cells = quantile_.size() - 1;
  for (std::size_t i = 0; i < cells / 2; ++i) {
    // The outermost knots would be infinite; a fifth of a cell keeps the variance at 1.
    const double probability =
        i == 0 ? 0.2 / static_cast<double>(cells) : static_cast<double>(i) / static_cast<double>(cells);
    quantile_[i] = static_cast<float>(normal_quantile(probability));
    quantile_[cells - i] = -quantile_[i];
  }
}

const NormalTable& NormalTable::instance() {
  static const NormalTable table;
  return table;
}

}  // namespace fusebench::simulator::random
