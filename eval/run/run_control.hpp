// How a caller follows and stops a run.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace fusebench::run {

struct RunControl {
  std::function<void(std::size_t frame, std::size_t total)> progress = {};  ///< after each frame
  const std::atomic<bool>* stop =
      nullptr;  ///< checked at each frame; true ends the run and leaves nothing behind
  /// Bad data met on the way (a damaged image) makes a record with status failed, as a suite needs it, which
  /// goes on. Otherwise it is an error of the run like any bad data met on opening, and nothing is left
  /// behind.
  bool bad_data_is_recorded = true;
  std::function<void()> preparing = {};  ///< before the recording is prepared, which takes seconds

  [[nodiscard]] bool is_stopped() const { return stop != nullptr && stop->load(); }
};

}  // namespace fusebench::run
