// The frames of a recording in order, the next one read while the current one is worked on.
#pragma once

#include <cstddef>
#include <future>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/estimator/health/stage_times.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::run {

struct LoadedFrame {
  RgbdFrame frame;
  health::TimeSpan decode;  ///< when it was read, on whichever thread
};

class FrameSource {
 public:
  /// read_ahead: on a thread of its own. The recording must outlive the source.
  FrameSource(const recording::Recording& recording, bool read_ahead);
  FrameSource(const FrameSource&) = delete;  // the thread that reads ahead holds on to this object
  FrameSource& operator=(const FrameSource&) = delete;

  /// The next frame; call at most frames.size() times. Errors: those of Recording::load_frame.
  [[nodiscard]] Result<LoadedFrame> next();

 private:
  void start_next();

  const recording::Recording& recording_;
  std::launch policy_;
  std::size_t following_ = 0;
  std::future<Result<LoadedFrame>> pending_;
};

}  // namespace fusebench::run
