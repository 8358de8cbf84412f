// What a folder of runs says, in sentences.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "eval/compare/findings/ranking.hpp"

namespace fusebench::findings {

/// Which configuration is best or which tie, by their mean ratios to the best of each recording. Nothing of
/// runs without numbers.
[[nodiscard]] std::optional<std::string> sentence_of(const Ranking& ranking);

/// Where loops were closed: the ATE of final poses against that of online poses. Nothing if no run has both.
[[nodiscard]] std::optional<std::string> final_poses_of(std::span<const run_files::FoundRun> runs);

/// What was lost, in whole or in part, failed or failed undetected, and where. A sentence that nothing did if
/// nothing did.
[[nodiscard]] std::vector<std::string> failures_of(const tables::ResultTable& table);

/// Versions, machines and threads.
[[nodiscard]] std::string origin_of(std::span<const run_files::FoundRun> runs);

}  // namespace fusebench::findings
