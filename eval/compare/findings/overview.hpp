// The answer of a folder of runs in one table: the ranked number of each recording and configuration.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "eval/compare/findings/ranking.hpp"
#include "eval/record/registry/replicated_numbers.hpp"

namespace fusebench::findings {

/// The runs of a configuration on a recording: repetitions and replicates.
struct OverviewCell {
  std::vector<std::size_t> members;  ///< indices of its runs; none: it was not run there
  std::size_t ok = 0;
  /// SI. median: the number by which it is ranked; range: over all runs that are ok.
  std::optional<registry::MedianRange> value = {};
  std::optional<double> tracked_share = {};    ///< of the frames
  std::optional<std::size_t> undetected = {};  ///< undetected failures, frames; absent without ground truth
  record::RunStatus status = record::RunStatus::ok;  ///< of the first run that is not ok
  /// The smallest number of its recording, and those whose range has a value in common with that one's.
  bool best = false;
};

struct OverviewRow {
  std::string recording;            ///< "slow", "slow [100:200]" where several windows were run
  std::vector<OverviewCell> cells;  ///< one a configuration of the ranking, in its order
};

/// table: from which the ranking was made.
[[nodiscard]] std::vector<OverviewRow> overview_of(const Ranking& ranking, const tables::ResultTable& table);

}  // namespace fusebench::findings
