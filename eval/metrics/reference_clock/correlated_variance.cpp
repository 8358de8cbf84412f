#include "eval/metrics/reference_clock/correlated_variance.hpp"

#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

namespace fusebench::reference_clock {

namespace {

constexpr std::int64_t kBin_ns = 100'000'000;
constexpr std::int64_t kCorrelation_ns = 1'000'000'000;
static_assert(1e-9 * static_cast<double>(kCorrelation_ns) == kCorrelation_s);

/// Sums of the terms within an interval.
struct Bin {
  std::int64_t number = 0;
  double value = 0;
  double information = 0;
};

std::vector<Bin> binned(std::span<const StampedTerm> terms, std::int64_t width_ns) {
  std::vector<Bin> bins;
  for (const StampedTerm& each : terms) {
    const std::int64_t number = (each.timestamp_ns - terms.front().timestamp_ns) / width_ns;
    if (bins.empty() || bins.back().number != number) bins.push_back({number, 0, 0});
    bins.back().value += each.value;
    bins.back().information += each.information;
  }
  return bins;
}

/// sum_ij max(0, 1 - |i - j| / width) v_i v_j over the bins.
double kernel_sum(std::span<const Bin> bins) {
  constexpr auto kWidth = static_cast<double>(kCorrelation_ns / kBin_ns);
  double sum = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    sum += bins[i].value * bins[i].value;
    for (std::size_t j = i + 1; j < bins.size(); ++j) {
      const auto lag = static_cast<double>(bins[j].number - bins[i].number);
      if (lag >= kWidth) break;
      sum += 2 * (1 - lag / kWidth) * bins[i].value * bins[j].value;
    }
  }
  return sum;
}

}  // namespace

double independent_terms(std::span<const StampedTerm> terms) {
  double sum = 0;
  double squares = 0;
  for (const Bin& second : binned(terms, kCorrelation_ns)) {
    sum += second.information;
    squares += second.information * second.information;
  }
  return squares > 0 ? sum * sum / squares : 0.0;
}

double correlated_variance(std::span<const StampedTerm> terms) {
  const double n = independent_terms(terms);
  if (!(n > 2)) return std::numeric_limits<double>::infinity();
  return kernel_sum(binned(terms, kBin_ns)) / (1 - 1 / n + 1 / (3 * n * n)) * n / (n - 2);
}

}  // namespace fusebench::reference_clock
