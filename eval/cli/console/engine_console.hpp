// What an engine shows while it works: a line for each finished run, and the runs in progress (progress.hpp).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/cli/console/progress.hpp"
#include "eval/cli/console/stop_signals.hpp"
#include "eval/suites/engine/job_plan.hpp"
#include "eval/suites/engine/local_engine.hpp"

namespace fusebench::cli::console {

class EngineConsole {
 public:
  explicit EngineConsole(std::span<const engine::BatchJob> jobs);
  [[nodiscard]] engine::EngineControl control();

 private:
  void tell(std::size_t index, const engine::BatchOutcome& outcome);
  void show(const engine::EngineState& state);

  StopScope stopping_{OnStop::end_itself};
  std::span<const engine::BatchJob> jobs_;
  Progress progress_{"runs"};
  std::size_t told_ = 0;
  std::size_t resumed_ = 0;
};

/// "3 failed, 12.5 runs/min, 35 min left"
[[nodiscard]] std::string rate_text(const engine::EngineState& state);

/// Simulates missing recordings of the jobs.
[[nodiscard]] Result<void> simulate_missing(const std::vector<engine::BatchJob>& jobs, int threads);

}  // namespace fusebench::cli::console
