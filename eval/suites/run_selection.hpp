// What a suite says of its runs besides recordings, variants and options: windows, repetitions, limits, and
// what is left out.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/options.hpp"
#include "eval/run/run.hpp"
#include "eval/suites/suite_entries.hpp"
#include "eval/suites/sweep_design.hpp"

namespace fusebench::suites {

/// Runs that are not made, and why.
///
///     [[exclude]]
///     reason = "no IMU was recorded"   # required; shown wherever the plan is
///     recording = "icl_*"              # a name, or with a final * its beginning; default: all
///     variant = "full"                 # or the name of an external program; default: all
///     tsdf.voxel_m = 0.02              # options that must have these values; default: any
struct Exclusion {
  std::string reason;
  std::string recording;
  std::string variant;
  SweepPoint options;
  std::string place;
  std::string variant_place = {};  ///< of `variant`; empty: all

  /// `options_of_run`: all of a run's effective options.
  [[nodiscard]] bool covers(std::string_view recording_name, std::string_view variant_name,
                            const std::vector<config::OptionRow>& options_of_run) const;
};
/// Errors: configuration, with file:line.
[[nodiscard]] Result<std::vector<Exclusion>> read_exclusions(const std::vector<EntryTable>& tables);
/// Whether each exclusion's variant is one, or one of `programs`, the names of the external programs of the
/// suite. Errors: configuration, with file:line.
[[nodiscard]] Result<void> check_excluded_variants(const std::vector<Exclusion>& exclusions,
                                                   const std::vector<std::string>& programs);

/// What each run may use. A run that needs more is a row with that reason.
///
///     [limits]
///     time_s = 3600      # from start to end; default: none
///     stall_s = 600      # without a finished frame; default 600
///     memory_mb = 4000   # of its own data (heap and stacks, and what it shares with the engine); default:
///     none
struct RunLimits {
  double time_s = 0;
  double stall_s = 600;
  std::uint64_t memory_bytes = 0;  ///< 0: none
};
/// Of one entry of [limits], by its key there. Errors: configuration, with file:line.
[[nodiscard]] Result<void> read_limit(const config::TomlEntry& entry, std::string_view key,
                                      RunLimits& limits);

/// frames = "0:100", or a list of such windows: each is a run of its own. Errors: configuration, with
/// file:line.
[[nodiscard]] Result<std::vector<run::FrameWindow>> windows_entry(const config::TomlEntry& entry);

}  // namespace fusebench::suites
