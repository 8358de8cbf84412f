// The runs that a suite asks for, in a fixed order.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/run/run.hpp"
#include "eval/suites/suite_file.hpp"
#include "eval/suites/sweep_design.hpp"

namespace fusebench::engine {

struct BatchOptions {
  std::filesystem::path data;
  std::filesystem::path out;
  std::filesystem::path simulated = "results/simulated";  ///< where the suite's simulated recordings are
  int threads = 1;
  bool profile = false;  ///< RunSpec::profile of each run
  /// key=value, after the suite's own edits; with several values (key=1,2,4) a sweep over them.
  std::vector<std::string> sets;
  /// "recording=TEXT" (name contains it), "variant=NAME" (exactly) or "split=NAME": one of each key that is
  /// there must hold.
  std::vector<std::string> only;
};

/// One run of the suite.
struct BatchJob {
  std::filesystem::path recording;
  std::string variant;
  run::RunSpec spec;
  bool optional = false;  ///< from `all = true`: skipped if its format or camera is unknown
  std::string group;      ///< of the recording, for summaries
  std::string split;      ///< "tuning" or "held-out"
  std::optional<suites::SimulationRequest> simulation = {};  ///< that makes the recording if it is not there
  suites::SweepPoint edits = {};                             ///< those of the sweep, or of a reading
};

/// "fr1_rpy full tsdf.voxel_m=0.02 frames 0:100 repetition 2 replicate 3", as far as it says something.
[[nodiscard]] std::string to_string(const BatchJob& job);

/// A run that the suite leaves out.
struct ExcludedRun {
  std::string run;  ///< as to_string() of its job
  std::string reason;
};

struct BatchPlan {
  std::vector<BatchJob> jobs;
  std::vector<ExcludedRun> excluded;
  std::vector<std::string> warnings;  ///< such as exclusions and filters that no run meets
  /// "NAME: where to get it" of each absent recording, "NAME: reason" of each external program that cannot
  /// run
  std::vector<std::string> absent = {};
};

/// By recording (those of the suite, then the simulated ones), window, repetition, replicate, variant as they
/// are listed, and point of the sweep: repetitions of one run are apart, so that a slow minute of the machine
/// does not meet all of them. What --only leaves out need not be there. Reads the definitions of external
/// programs, and asks each that is wanted for its version. Errors: those of read_external_program();
/// data_missing (a recording or a trajectory that is not there), configuration (--set, a recording named
/// twice, a point of the sweep that no run can have, an exclusion of a variant that there is not), usage
/// (--only that names no key, recording or variant, or leaves nothing).
[[nodiscard]] Result<BatchPlan> plan_batch(const suites::Suite& suite, const BatchOptions& options);

}  // namespace fusebench::engine
