// Experiments are data: a suite is a TOML file that names recordings, variants and edits of the
// configuration.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config_access.hpp"
#include "core/error.hpp"
#include "core/toml_document.hpp"
#include "core/variants.hpp"
#include "eval/run.hpp"

namespace fusebench {

/// A suite runs every variant over every recording.
///
///     name = "quickstart"             # required
///     recordings = ["fr1_rpy", ...]   # folders, or names of folders under --data; this, or
///     all = true                      # every recording under --data
///     variants = ["full", "dm"]       # required
///     imu = "synthetic"               # or "recorded" (default): what a variant that needs an IMU gets
///     [config]                        # edits for all runs, as in a configuration file
///     iekf.max_iterations = 8
struct Suite {
  std::string name;
  bool all = false;
  std::vector<std::string> recordings;
  std::vector<std::string> variants;
  ImuChoice imu = ImuChoice::recorded;
  std::vector<TomlEntry> config;  ///< keys without "config."
};

/// Errors name file:line: data_missing (no such file), configuration (unknown key or variant, wrong type, a
/// value that the option does not take, a missing or doubled key).
[[nodiscard]] Result<Suite> read_suite(const std::filesystem::path& file);

/// The configuration of one of the suite's variants, before --set.
[[nodiscard]] Result<EffectiveConfig> suite_config(const Suite& suite, const Variant& variant);

/// "recorded" or "synthetic". Error configuration.
[[nodiscard]] Result<ImuChoice> parse_imu_choice(const std::string& text);

/// A folder as it is named, else the folder of that name under `data` (may be empty). Error data_missing that
/// lists what is under `data`, with the nearest name.
[[nodiscard]] Result<std::filesystem::path> find_recording(const std::string& name,
                                                           const std::filesystem::path& data);

/// The folders under `data` that hold a recording, by name. Errors: data_missing if `data` is no folder or
/// has none.
[[nodiscard]] Result<std::vector<std::filesystem::path>> recordings_under(const std::filesystem::path& data);

}  // namespace fusebench
