// Options that were drawn at random have a value of their own in each run: effects are then of stretches of
// values.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "eval/compare/aggregate/run_rows.hpp"

namespace fusebench::aggregate {

/// The rows, with each number of an option that has more than `most` different ones replaced by the mean of
/// its bin: `bins` bins of neighbouring values with equally many different values each. Options with values
/// that are no numbers stay as they are.
[[nodiscard]] std::vector<RunRow> with_binned_options(std::span<const RunRow> rows, std::size_t most = 12,
                                                      std::size_t bins = 6);

}  // namespace fusebench::aggregate
