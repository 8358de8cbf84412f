// How durations are spread: percentiles, and counts in logarithmic bins that are the same for every
// histogram.
#pragma once

#include <cstddef>
#include <vector>

namespace fusebench::record {

/// Milliseconds. Percentiles interpolate linearly between the two nearest durations.
struct DurationHistogram {
  std::size_t count = 0;
  double min_ms = 0;
  double median_ms = 0;
  double p90_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
  /// Rising, one more than counts: bin i holds the durations from edge i to below edge i + 1. Edges are those
  /// of a fixed grid with ten bins a decade (1, 1.25, 1.6, 2, 2.5, 3.15, 4, 5, 6.3, 8 ms and so on, the
  /// preferred numbers R10), cut to the durations there are. Below 100 ns everything is in the first bin of
  /// the grid, from 1000 s on in the last.
  std::vector<double> edges_ms;
  std::vector<std::size_t> counts;
};

/// Of one duration or more, in any order.
[[nodiscard]] DurationHistogram histogram_of(std::vector<double> durations_ms);

}  // namespace fusebench::record
