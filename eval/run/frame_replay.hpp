// Replays the processed frames of a run after the system has revised their poses.
#pragma once

#include <cstddef>

#include "core/base/error.hpp"
#include "core/base/replay.hpp"
#include "eval/run/run_control.hpp"
#include "eval/run/run_placement.hpp"

namespace fusebench::run {

/// The replay interface of a run (base/replay.hpp).
class FrameReplay {
 public:
  /// The references must outlive it.
  FrameReplay(const PreparedRun& run, const RunControl& control) : run_(run), control_(control) {}

  /// Sets the number of frames that the system has processed.
  void set_seen(std::size_t frames) { seen_ = frames; }

  /// Visits the processed frames in order. Errors: run_failed (a stop), those of the recording and the
  /// visitor.
  [[nodiscard]] Result<void> visit(const FrameVisitor& visitor) const;

 private:
  const PreparedRun& run_;
  const RunControl& control_;
  std::size_t seen_ = 0;
};

}  // namespace fusebench::run
