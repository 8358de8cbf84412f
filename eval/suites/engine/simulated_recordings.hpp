// Makes the simulated recordings that a suite's jobs need and that are not there yet.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/simulator/simulation.hpp"
#include "eval/suites/engine/job_plan.hpp"

namespace fusebench::engine {

struct SimulatingControl {
  std::function<void(const std::string& recording, std::size_t index, std::size_t count)> started = {};
  std::function<void(std::size_t done, std::size_t total)> progress = {};
  /// lines: what there is to say of it; none if it was there already.
  std::function<void(const std::vector<std::string>& lines)> finished = {};
  const std::atomic<bool>* stop = nullptr;
};

/// What can be said against the simulations of these jobs before anything is made. Error configuration, with
/// the recording's name.
[[nodiscard]] Result<void> check_simulations(const std::vector<BatchJob>& jobs);

/// Each recording once, in the order of the jobs; one that is there is left as it is. Each is made in a
/// process of its own, so that this one keeps its single thread. Errors: those of simulate(), with the
/// recording's name; the recordings before it stay.
[[nodiscard]] Result<void> make_simulated_recordings(const std::vector<BatchJob>& jobs, int threads,
                                                     const SimulatingControl& control = {});

}  // namespace fusebench::engine
