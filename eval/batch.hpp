// Runs a suite: every recording with its variants, one after the other, in a fixed order.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "eval/experiment.hpp"
#include "eval/record.hpp"
#include "eval/run.hpp"

namespace fusebench {

struct BatchOptions {
  std::filesystem::path data;
  std::filesystem::path out;
  std::filesystem::path simulated = "results/simulated";  ///< where the suite's simulated recordings are
  int threads = 1;
  std::vector<std::string> sets;  ///< key=value, after the suite's own edits
  /// "recording=TEXT" (name contains it) or "variant=NAME" (exactly); all must hold.
  std::vector<std::string> only;
  bool resume = false;  ///< leaves alone what has a record with status ok or lost and the same hash
};

/// One run of the suite.
struct BatchJob {
  std::filesystem::path recording;
  std::string variant;
  RunSpec spec;
  bool optional = false;  ///< from `all = true`: skipped if its format or camera is unknown
  std::string group;      ///< of the recording, for summaries
  std::string half;       ///< "tuning" or "held-out"
  std::optional<SimulationRequest> simulation = {};  ///< that makes the recording if it is not there
};

/// The jobs in order: by recording (those of the suite, then the simulated ones), then by variant as they are
/// listed. What --only leaves out need not be there. Errors: data_missing (a recording or a trajectory that
/// is not there), configuration (--set, a recording named twice), usage (--only that names no key or leaves
/// nothing).
[[nodiscard]] Result<std::vector<BatchJob>> plan_batch(const Suite& suite, const BatchOptions& options);

/// How a job ended. One that did not even start, or whose results could not be written, has no folder, the
/// status failed, and a record under <out>/<recording>/<variant>/not-started/, so that tables show it.
struct BatchOutcome {
  std::string recording;
  std::string variant;
  std::string group;
  std::string half;
  RunStatus status = RunStatus::failed;
  std::string reason;
  bool resumed = false;  ///< was there already
  bool skipped = false;  ///< an optional job whose recording nothing here can open; not a failure, and no row
  std::filesystem::path folder;
  RunRecord record;  ///< without a folder: names the recording, the variant and the configuration alone
};

struct BatchControl {
  std::function<void(const BatchJob& job, std::size_t index, std::size_t count)> started = {};
  std::function<void(std::size_t frame, std::size_t total)> progress = {};
  std::function<void(const BatchOutcome& outcome)> finished = {};
  const std::atomic<bool>* stop = nullptr;
};

/// A run that fails or is lost is an outcome with its reason; the others go on. Error run_failed if it was
/// stopped.
[[nodiscard]] Result<std::vector<BatchOutcome>> run_batch(const std::vector<BatchJob>& jobs, bool resume,
                                                          const BatchControl& control = {});

/// How a job ends that left nothing; writes no file.
[[nodiscard]] BatchOutcome without_results(const BatchJob& job, std::string reason);

/// The same, with a record that says so in the place of a run, for tables.
[[nodiscard]] BatchOutcome not_started(const BatchJob& job, std::string reason);

}  // namespace fusebench
