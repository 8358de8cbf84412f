#include "eval/record/duration_histogram.hpp"

#include <algorithm>
#include <array>

#include "core/base/error.hpp"
#include "eval/metrics/mesh_error/mesh_metrics.hpp"

namespace fusebench::record {

namespace {

/// All edges there can be.
std::vector<double> grid_ms() {
  constexpr std::array<double, 10> kDecade_ns = {100, 125, 160, 200, 250, 315, 400, 500, 630, 800};
  constexpr double kMost_ns = 1e12;
  constexpr double kNsPerMs = 1e6;
  std::vector<double> edges_ms;
  // Whole nanoseconds, so that each quotient is the double nearest to its decimal and prints like it.
  for (double factor = 1; kDecade_ns[0] * factor < kMost_ns; factor *= 10) {
    for (const double edge_ns : kDecade_ns) edges_ms.push_back(edge_ns * factor / kNsPerMs);
  }
  edges_ms.push_back(kMost_ns / kNsPerMs);
  return edges_ms;
}

}  // namespace

DurationHistogram histogram_of(std::vector<double> durations_ms) {
  check(!durations_ms.empty(), "a histogram of something");
  std::ranges::sort(durations_ms);
  DurationHistogram histogram;
  histogram.count = durations_ms.size();
  histogram.min_ms = durations_ms.front();
  histogram.median_ms = mesh_error::percentile(durations_ms, 0.5);
  histogram.p90_ms = mesh_error::percentile(durations_ms, 0.9);
  histogram.p99_ms = mesh_error::percentile(durations_ms, 0.99);
  histogram.max_ms = durations_ms.back();

  const std::vector<double> edges_ms = grid_ms();
  const auto bin_of = [&](double duration_ms) {
    const auto above = std::ranges::upper_bound(edges_ms, duration_ms) - edges_ms.begin();
    return std::clamp<std::ptrdiff_t>(above - 1, 0, static_cast<std::ptrdiff_t>(edges_ms.size()) - 2);
  };
  const std::ptrdiff_t first = bin_of(durations_ms.front());
  const std::ptrdiff_t last = bin_of(durations_ms.back());
  histogram.edges_ms.assign(edges_ms.begin() + first, edges_ms.begin() + last + 2);
  histogram.counts.assign(static_cast<std::size_t>(last - first) + 1, 0);
  for (const double duration_ms : durations_ms)
    ++histogram.counts[static_cast<std::size_t>(bin_of(duration_ms) - first)];
  return histogram;
}

}  // namespace fusebench::record
