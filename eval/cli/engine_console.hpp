// What an engine shows while it works: one line that is redrawn on a terminal, one line a finished run
// elsewhere.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "eval/cli/console.hpp"
#include "eval/engine/job_plan.hpp"
#include "eval/engine/local_engine.hpp"

namespace fusebench {

class EngineConsole {
 public:
  explicit EngineConsole(std::span<const BatchJob> jobs);
  [[nodiscard]] EngineControl control();
  void clear();

 private:
  void tell(std::size_t index, const BatchOutcome& outcome);
  void show(const EngineState& state);

  std::span<const BatchJob> jobs_;
  bool terminal_;
  std::size_t told_ = 0;
  std::size_t resumed_ = 0;
};

/// "3 failed, 12.5 runs/min, 35 min left"
[[nodiscard]] std::string rate_text(const EngineState& state);

/// Makes the simulated recordings that the jobs need and that are not there.
[[nodiscard]] Result<void> simulate_missing(const std::vector<BatchJob>& jobs, int threads);

}  // namespace fusebench
