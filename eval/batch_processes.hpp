// The jobs of a batch, several at a time, each in a process of its own: CPU time and memory are then those of
// one run, and a run that crashes takes nothing with it.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "eval/batch.hpp"

namespace fusebench {

/// How a process is started for jobs[index]: it must do that job alone and print the document of `bench
/// --json`.
using JobCommand = std::function<std::vector<std::string>(std::size_t index)>;

struct ProcessControl {
  /// In the order in which they end.
  std::function<void(std::size_t index, const BatchOutcome& outcome)> finished = {};
  const std::atomic<bool>* stop = nullptr;
};

/// As run_batch(), with the outcomes in the order of the jobs. A record counts only if it is of the job's
/// recording, variant and configuration and ended as the process says. `at_once` is 1 or more. Errors: io (no
/// process can be started), run_failed (stopped); all processes are then asked to stop, too, and waited for.
[[nodiscard]] Result<std::vector<BatchOutcome>> run_batch_in_processes(const std::vector<BatchJob>& jobs,
                                                                       int at_once, const JobCommand& command,
                                                                       const ProcessControl& control = {});

}  // namespace fusebench
