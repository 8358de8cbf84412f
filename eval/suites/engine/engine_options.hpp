// What every engine is told, and what it tells while it works.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "eval/suites/engine/job_outcome.hpp"
#include "eval/suites/run_selection.hpp"

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

}  // namespace fusebench::engine
