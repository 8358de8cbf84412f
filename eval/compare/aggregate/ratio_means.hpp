// Which of several configurations is best over recordings, by their ratios to the best of each recording.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace fusebench::aggregate {

/// values[recording][configuration]: a number of each ok run (repetitions and replicates); empty where the
/// configuration has none.
using ReplicatedValues = std::vector<std::vector<std::vector<double>>>;

struct RatioMean {
  /// Geometric mean, over the recordings that the configuration has numbers of, of its median / the smallest
  /// median of the recording. Absent without numbers, and where any number is not positive.
  std::optional<double> ratio = {};
  std::size_t recordings = 0;
  /// 95 % interval of `ratio`; absent of one recording without replicates.
  std::optional<std::array<double, 2>> interval = {};
  /// Whether chance explains the difference from the configuration with the smallest ratio: the 95 % interval
  /// of the ratio between both contains 1. True of that one; without an interval only of equal ratios.
  bool tied = false;
};

/// One a configuration. Intervals are percentiles of a bootstrap over recordings, and over the runs of each
/// (seed fixed: the same values give the same intervals). The smallest ratio is that of the configurations
/// with the most recordings. They are not corrected for picking the best of several.
[[nodiscard]] std::vector<RatioMean> ratio_means(const ReplicatedValues& values);

}  // namespace fusebench::aggregate
