// Progress callbacks and stop flag of a run.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace fusebench::run {

struct RunControl {
  std::function<void(std::size_t frame, std::size_t total)> progress = {};  ///< after each frame
  const std::atomic<bool>* stop =
      nullptr;  ///< checked at each frame; true ends the run and removes its files
  /// Bad data during the run (a damaged image) gives a record with status failed, for suites. With false it
  /// is an error, like bad data on opening, and no files remain.
  bool bad_data_is_recorded = true;
  std::function<void()> preparing = {};  ///< before the recording is prepared, which takes seconds

  [[nodiscard]] bool is_stopped() const { return stop != nullptr && stop->load(); }
};

}  // namespace fusebench::run
