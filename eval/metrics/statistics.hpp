// The one definition of rmse, mean, median, std, min, max and sse that all metrics report.
#pragma once

#include <cstddef>
#include <limits>
#include <span>

namespace fusebench::metrics {

/// Of no values: count 0 and NaN elsewhere.
struct Statistics {
  double rmse = std::numeric_limits<double>::quiet_NaN();  ///< sqrt(sse / count)
  double mean = std::numeric_limits<double>::quiet_NaN();
  double median =
      std::numeric_limits<double>::quiet_NaN();           ///< mean of the two middle values if count is even
  double std = std::numeric_limits<double>::quiet_NaN();  ///< of the population (ddof 0)
  double min = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();
  double sse = std::numeric_limits<double>::quiet_NaN();  ///< sum of squares
  std::size_t count = 0;
};

/// Sums run in index order. Values must be finite.
[[nodiscard]] Statistics statistics(std::span<const double> values);

}  // namespace fusebench::metrics
