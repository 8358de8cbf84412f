// The configurations than which no other is both better and cheaper.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::aggregate {

struct ParetoPoint {
  std::string variant;
  RunOptions options;
  double cpu_ms_per_frame = 0;  ///< both numbers are means over recordings, as best_configurations() has them
  double value = 0;             ///< of the metric, in its unit
  bool on_front = false;
};

struct ParetoFront {
  const registry::RunMetric* metric = nullptr;
  std::vector<std::string> recordings;  ///< that every point is a mean over
  std::vector<ParetoPoint> points;      ///< by time, then value; equal ones by variant and options
  /// Configurations that lost, failed or did not run some recordings: their means do not compare.
  std::size_t left_out = 0;

  /// Those of `points` on the front: less time goes with a worse value. Several with the same two numbers are
  /// all on it; of those with one number the same, the one whose other number is better.
  [[nodiscard]] std::vector<ParetoPoint> front() const;
};

/// The metric must be one in which less is better. The runs should be on data of one kind, as
/// recording_kinds() says, and of one machine, whose times compare. Does not depend on the order of the runs.
[[nodiscard]] ParetoFront pareto_front(std::span<const RunRow> rows, const registry::RunMetric& metric);

}  // namespace fusebench::aggregate
