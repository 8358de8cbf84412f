// Experiments are data: a suite is a TOML file that names recordings, variants and edits of the
// configuration.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/config_access.hpp"
#include "core/config/toml_document.hpp"
#include "core/config/variants.hpp"
#include "eval/run/run.hpp"
#include "eval/suites/acceptance_criteria.hpp"
#include "eval/suites/run_selection.hpp"
#include "eval/suites/suite_simulations.hpp"
#include "eval/suites/sweep_design.hpp"

namespace fusebench::suites {

/// A recording that exists, as a suite names it.
///
///     [[recordings]]                      # or, at the top of the file: recordings = ["fr1_rpy", ...]
///     name = "rgbd_dataset_freiburg1_*"   # a final * takes all folders under --data that begin so
///     group = "fr1"                       # default: the recording's own name
///     split = "tuning"                     # or "held-out" (default)
///     variants = ["full"]                 # default: those of the suite
///     source = "scripts/fetch_datasets.sh fr1_xyz"   # where to get it; one with a source may be absent
struct SuiteRecording {
  std::string name;
  std::string group = {};  ///< empty: the recording's name
  std::string split = std::string(kHeldOutSplit);
  std::vector<std::string> variants = {};
  std::string source =
      {};  ///< not empty: an absent recording is reported with it, and the suite runs the others
};

/// A suite runs every variant over every recording.
///
///     name = "quickstart"             # required
///     recordings = ["fr1_rpy", ...]   # folders, names of folders under --data or of the catalogue; or
///     all = true                      # every recording under --data; or simulated ones (SuiteSimulation)
///     variants = ["full", "dm"]       # required
///     systems = ["configs/systems/open3d.toml"]   # external programs, over the same recordings; files are
///                                     # read when runs are planned (engine::plan_batch())
///     imu = "synthetic"               # or "auto", "recorded" (default): see ImuChoice
///     prepare = "off"                 # or "auto" (default): measure first what a calibration leaves open
///     [config]                        # edits for all runs, as in a configuration file
///     iekf.max_iterations = 8
///     repetitions = 3                 # of each run, for its time; default 1
///     replicates = 5                  # of each run, from initial poses with noise; default 1
///     frames = ["0:100", "100:200"]   # windows of the recordings, each a run; default: all frames
///     keep = "small"                  # files of each run, see KeptFiles; default "all"
///     [limits]                        # see RunLimits
///     [[sweep]]                       # see SweepBlock
///     [[exclude]]                     # see Exclusion
///     [[simulations]]                 # see SuiteSimulation
///     [[criteria]]                        # what the runs must reach: see Criterion
struct Suite {
  std::string name;
  bool all = false;
  std::vector<SuiteRecording> recordings;
  std::vector<SuiteSimulation> simulations;
  std::vector<std::string> variants;
  std::vector<std::string> systems;  ///< files that define external programs, as the suite names them
  run::ImuChoice imu = run::ImuChoice::recorded;
  bool prepare = true;                    ///< RunSpec::prepare of each run
  std::vector<config::TomlEntry> config;  ///< keys without "config."
  int repetitions = 1;
  int replicates = 1;
  std::vector<run::FrameWindow> windows;  ///< empty: all frames
  run::KeptFiles kept = run::KeptFiles::all;
  RunLimits limits;
  std::vector<SweepBlock> sweeps;
  std::vector<Exclusion> exclusions;
  std::vector<Criterion> criteria;
};

/// Errors name file:line: data_missing (no such file), configuration (unknown key or variant, wrong type, a
/// value that the option does not take, a missing or doubled key).
[[nodiscard]] Result<Suite> read_suite(const std::filesystem::path& file);
/// The same of a text; `name` stands for the file in messages.
[[nodiscard]] Result<Suite> parse_suite(std::string_view text, const std::string& name);

/// The suite's variants, and those of its recordings, each once.
[[nodiscard]] std::vector<std::string> variants_of(const Suite& suite);

/// The configuration of one of the suite's variants, before --set.
[[nodiscard]] Result<config::EffectiveConfig> suite_config(const Suite& suite,
                                                           const config::Variant& variant);

/// "recorded", "synthetic" or "auto". Error configuration.
[[nodiscard]] Result<run::ImuChoice> parse_imu_choice(const std::string& text);

}  // namespace fusebench::suites
