// Parameter sweeps as data: which values of which options are tried together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "core/config/options.hpp"
#include "eval/suites/suite_entries.hpp"

namespace fusebench::suites {

/// Of one plan, and so points of its sweeps. A plan is held in memory and looked through as a whole.
inline constexpr std::size_t kMostRuns = 100'000;

/// One option of a sweep: the values that are tried, or the range that they are drawn from.
struct SweepAxis {
  struct Range {
    double from = std::numeric_limits<double>::quiet_NaN();
    double to = std::numeric_limits<double>::quiet_NaN();
    std::size_t steps = 0;  ///< of grid and zip: so many values, both ends among them
    bool log = false;       ///< equal ratios in place of equal differences
  };
  std::string key;
  std::vector<config::OptionValue> values;  ///< empty: see range
  std::optional<Range> range;
  std::string place;
};

enum class SweepDesign {
  grid,             ///< every value with every other; the first axis changes slowest
  zip,              ///< first values together, second values together, ...
  random,           ///< each sample independent, uniform over ranges (of the logarithm) and lists
  latin_hypercube,  ///< each axis in as many equal parts as there are samples, one sample in each (McKay
                    ///< 1979)
};

/// One design. Several of them are multiplied with each other.
///
///     [[sweep]]
///     design = "grid"                   # default; or "zip", "random", "latin-hypercube"
///     samples = 20                      # of random and latin-hypercube, required there
///     seed = 1                          # of the same; default 1
///     iekf.max_iterations = [1, 2, 4]   # any option: a list of values, or a range
///     tsdf.voxel_m = { from = 0.005, to = 0.02, steps = 3, scale = "log" }   # default: "linear"
struct SweepBlock {
  SweepDesign design = SweepDesign::grid;
  std::size_t samples = 0;
  std::uint64_t seed = 1;
  std::vector<SweepAxis> axes;
};

/// What one run of a sweep edits.
using SweepPoint = std::vector<std::pair<std::string, config::OptionValue>>;

/// Errors: configuration, with file:line: unknown keys and options, lists of unequal length in a zip, ranges
/// that are none, a logarithmic range that is not positive, an option that is swept twice.
[[nodiscard]] Result<std::vector<SweepBlock>> read_sweeps(const std::vector<EntryTable>& tables);

/// Takes the assignments with several values ("key=1,2,4") out of --set, as a grid.
[[nodiscard]] Result<std::optional<SweepBlock>> take_swept_sets(std::vector<std::string>& sets);

/// All points, the same for the same blocks on every machine. A single empty point without blocks. Numbers
/// that are computed have six significant digits; those of integer options are rounded. Points that are then
/// equal appear once. Error configuration for more than kMostRuns.
[[nodiscard]] Result<std::vector<SweepPoint>> sweep_points(const std::vector<SweepBlock>& blocks);

/// "iekf.max_iterations=4 tsdf.voxel_m=0.01"; empty of the empty point.
[[nodiscard]] std::string to_string(const SweepPoint& point);

}  // namespace fusebench::suites
