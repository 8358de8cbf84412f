// The mean of ratios over recordings, and how sure it is.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace fusebench::aggregate {

struct MeanRatio {
  double ratio = 1;       ///< geometric mean
  std::size_t count = 0;  ///< of recordings
  /// 95 % interval of it (Student's t on the logarithms); absent of fewer than two recordings.
  std::optional<std::array<double, 2>> interval = {};
};

/// Of the natural logarithms of the ratios, one a recording. 1 of none.
[[nodiscard]] MeanRatio mean_ratio(std::span<const double> logarithms);

}  // namespace fusebench::aggregate
