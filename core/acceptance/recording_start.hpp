// Where and how a recording starts. Not in the paper.
//
// The first frames may be of no use: an automatic exposure begins in the dark. Frames that nothing could be
// tracked from are lost, until there is one that can be the first. If then hardly a frame is tracked from it
// either (it was only dim, or showed little more than a plain wall), the estimator starts again at a later
// frame: a model of a few frames is no loss, and one that the camera does not see again would keep it lost.
//
// A recording that starts in motion starts with an unknown velocity. The first two frames tell it,
// so they are processed again with it: the first one is then compensated properly, and the second one
// predicted well.
#pragma once

#include "core/config/groups/config_fwd.hpp"
#include "core/health/frame_report.hpp"

namespace fusebench::acceptance {

/// What has to be done after a frame at the beginning of a recording.
enum class StartAction {
  go_on,
  wait,        ///< the frame cannot be the first one: forget it
  start_here,  ///< hardly a frame was tracked from the first one: forget all, and process this one as the
               ///< first
  start_again  ///< forget all, and process the first two frames again, with the velocity that is known now
};

class RecordingStart {
 public:
  /// The configuration must outlive it.
  explicit RecordingStart(const config::InitialisationConfig& config) : config_(config) {}

  /// After each frame that was processed, but not the first one of start_again. The first frame (status
  /// initialised) has the health of judge_start().
  [[nodiscard]] StartAction judge(const health::FrameReport& report);

 private:
  [[nodiscard]] bool is_false_start(const health::FrameReport& report);

  const config::InitialisationConfig& config_;
  bool is_second_ = false;  ///< the next frame is the one after the first
  bool confirmed_ = false;  ///< enough frames were tracked after the first one
  int lost_frames_ = 0;     ///< since the first one
  int tracked_frames_ = 0;  ///< the same
};

}  // namespace fusebench::acceptance
