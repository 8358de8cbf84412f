// The runs of a plan on this machine: each in a process of its own, several at a time, none twice.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/engine/job_outcome.hpp"
#include "eval/engine/job_plan.hpp"
#include "eval/suites/suite_runs.hpp"

namespace fusebench::engine {

struct EngineOptions {
  int at_once = 1;
  suites::RunLimits limits = {};
  bool repeat_finished = false;  ///< runs what is there already, too
  bool only_failed = false;      ///< runs only what is there as failed
};

/// Where the engine is.
struct EngineState {
  std::size_t jobs = 0;
  std::size_t ended = 0;    ///< of them
  std::size_t resumed = 0;  ///< of those that ended: were there already
  std::size_t failed = 0;   ///< of those that ended: failed or lost
  double elapsed_s = 0;
  double share_running = 0;  ///< sum over running jobs of the share of their frames that is done
  std::vector<std::string> running;
};

struct EngineControl {
  /// In the order in which they end.
  std::function<void(std::size_t index, const BatchOutcome& outcome)> finished = {};
  std::function<void(const EngineState& state)> progress = {};  ///< a few times a second
  const std::atomic<bool>* stop = nullptr;
};

/// Runs the jobs and gives their outcomes in the order of the jobs. A finished run (ok or lost) of the same
/// identity is left as it is; a failed one is tried again. A run that fails, crashes, hangs or needs too much
/// memory is an outcome with its reason, and the others go on. Fewer than `at_once` run while the machine's
/// memory would not hold one more. What is being run by another engine on the same folder is waited for.
///
/// No other thread of this process may be at work: processes are forked from it. Errors: io (results cannot
/// be written: nothing more is started, finished runs stay, and the same call goes on later), run_failed
/// (stopped: runs that were not finished leave nothing).
[[nodiscard]] Result<std::vector<BatchOutcome>> run_locally(std::span<const BatchJob> jobs,
                                                            const EngineOptions& options,
                                                            const EngineControl& control = {});

}  // namespace fusebench::engine
