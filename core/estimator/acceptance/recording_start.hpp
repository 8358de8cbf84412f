// Selects the first frame of a recording. Not in the paper.
//
// The first frames may be unusable, for example dark until the automatic exposure has settled. They are lost
// until a frame is suitable as the first one. If hardly any later frame is tracked from it (it was dim, or
// showed little more than a plain wall), the estimator starts again at a later frame.
//
// A recording that starts in motion has an unknown initial velocity. It is estimated from the first two
// frames. Both are then processed again with this velocity, which improves the compensation of the first
// frame and the prediction of the second.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/health/frame_report.hpp"

namespace fusebench::acceptance {

/// Action after a frame at the beginning of a recording.
enum class StartAction {
  go_on,
  wait,        ///< the frame is unsuitable as the first one: discard it
  start_here,  ///< too few frames were tracked from the first one: reset, and process this frame as the first
  start_again  ///< reset, and process the first two frames again with the estimated velocity
};

class RecordingStart {
 public:
  /// The configuration must outlive it.
  explicit RecordingStart(const config::InitialisationConfig& config) : config_(config) {}

  /// Call it after each processed frame, except after the first frame of start_again. The first frame (status
  /// initialised) has the health of judge_start().
  [[nodiscard]] StartAction judge(const health::FrameReport& report);

 private:
  [[nodiscard]] bool is_false_start(const health::FrameReport& report);

  const config::InitialisationConfig& config_;
  bool is_second_ = false;  ///< the next frame is the one after the first
  bool confirmed_ = false;  ///< enough frames were tracked after the first one
  int lost_frames_ = 0;     ///< since the first frame
  int tracked_frames_ = 0;  ///< since the first frame
};

}  // namespace fusebench::acceptance
