// Which runs are replicates of each other.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "eval/run_files/found_runs.hpp"

namespace fusebench::run_files {

/// Indices of the runs that differ in nothing but their replicate, by replicate; a run without replicates is
/// a group of its own. In the order of each group's first run.
[[nodiscard]] std::vector<std::vector<std::size_t>> replicate_groups(std::span<const FoundRun> runs);

}  // namespace fusebench::run_files
