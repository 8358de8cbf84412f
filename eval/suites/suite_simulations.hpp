// Simulated recordings that a suite declares, with their lists multiplied out.
#pragma once

#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/simulation_request.hpp"
#include "eval/suites/suite_entries.hpp"

namespace fusebench::suites {

/// Which split of a study a recording belongs to: parameters are chosen by looking at one split only, and
/// criteria are set on the other.
inline constexpr std::string_view kTuningSplit = "tuning";
inline constexpr std::string_view kHeldOutSplit = "held-out";
[[nodiscard]] constexpr bool is_split(std::string_view name) {
  return name == kTuningSplit || name == kHeldOutSplit;
}

/// One recording to simulate.
///
///     [[simulations]]
///     name = "zr300_{preset}_{start}_{seed}"  # required; {key} stands for the value of that key
///     format = "zr300"                        # zr300 (default), tum, icl
///     preset = ["slow", "fast"]               # a list makes a recording for each of its values
///     start = ["rest", "motion"]              # default: rest with a preset, motion with a trajectory
///     seed = [1, 2, 3, 4]
///     tuning_seeds = [1, 3]                   # these seeds are the tuning split, the others are held out
///     duration_s = 5
///     group = "{preset}"                      # default: the preset; required with a trajectory
///     variants = ["full"]                     # default: those of the suite
///     trajectory = "path.txt"                 # instead of a preset; relative to --data
///     speed = 4                               # of the trajectory; skip_s: of its beginning
///     realistic = true                        # realistic sensors (always with presets realistic_*)
///     size = "640x480"; rate_hz, exposure_s, blur_samples, rolling_shutter_s, time_offset_s, no_noise
///     faults = ["hand=1:2:0.4"]               # all of each recording, as `simulate --fault` takes them
///     calibration_error = "1:1"; untold_time_offset_s  # as on the command line
///
/// A recording may be declared again with the same values, to add variants.
struct SuiteSimulation {
  std::string name;
  SimulationRequest request;  ///< its trajectory as it is written
  std::string group;
  std::string split;
  std::vector<std::string> variants;
  std::string described;  ///< key = value, ...: what tells one recording from another
  std::string place;
};

/// In the order of the file, the first key of a table slowest. Errors: configuration, with file:line.
[[nodiscard]] Result<std::vector<SuiteSimulation>> read_simulations(
    const std::vector<EntryTable>& tables, const std::vector<std::string>& suite_variants);

}  // namespace fusebench::suites
