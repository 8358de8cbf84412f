// The numbers of a run over its replicates: medians and ranges.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/record/registry/run_numbers.hpp"

namespace fusebench::registry {

/// The median of a number over runs, with its range.
struct MedianRange {
  double median = 0;
  double least = 0;
  double most = 0;

  /// Whether the ranges have a value in common: then chance explains the difference.
  [[nodiscard]] bool overlaps(const MedianRange& other) const {
    return least <= other.most && other.least <= most;
  }
};

/// Nothing of no values. The median of an even number is the mean of the two in the middle.
[[nodiscard]] std::optional<MedianRange> median_range(std::vector<double> values);

/// Of those runs that have the number.
[[nodiscard]] std::optional<MedianRange> median_range(std::span<const RunNumbers> runs,
                                                      const RunMetric& metric);

/// The median of each number that all of the runs have.
[[nodiscard]] RunNumbers medians_of(std::span<const RunNumbers> runs);

/// "1.22", or "1.22 [1.10, 1.40]" where the shown numbers differ; "-" of nothing.
[[nodiscard]] std::string shown_text(const RunMetric& metric, const std::optional<MedianRange>& value);

/// (most - least) / median of the ATE: how much of it is chance. Nothing of fewer than two runs with one.
[[nodiscard]] std::optional<double> sensitivity_of(std::span<const RunNumbers> runs);

}  // namespace fusebench::registry
