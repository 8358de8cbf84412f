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

#include <optional>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/filter/filter_state.hpp"
#include "core/health/frame_report.hpp"

namespace fusebench::core {

/// An estimator that can begin again.
class RestartableEstimator {
 public:
  RestartableEstimator() = default;
  RestartableEstimator(const RestartableEstimator&) = delete;
  RestartableEstimator& operator=(const RestartableEstimator&) = delete;
  virtual ~RestartableEstimator() = default;

  /// The first frame (status initialised) has the health of judge_start().
  [[nodiscard]] virtual Result<health::FrameReport> process_frame(const RgbdFrame& frame) = 0;
  /// The state after the last frame; nothing before the first one.
  [[nodiscard]] virtual const std::optional<filter::GaussianState>& estimate() const = 0;
  /// Forgets all frames, to begin with the velocities of this state if there is one.
  virtual void restart(const std::optional<filter::FilterState>& motion) = 0;
};

class RecordingStart {
 public:
  /// The configuration must outlive it.
  explicit RecordingStart(const config::InitialisationConfig& config) : config_(config) {}

  /// Processes the next frame. One that cannot be the first is lost, and its reason says so. The second one
  /// is processed together with the first one again; its report has the time of all of that. A later start
  /// has the status initialised and a reason: the frames before do not count any more.
  [[nodiscard]] Result<health::FrameReport> process(const RgbdFrame& frame, RestartableEstimator& estimator);

 private:
  [[nodiscard]] Result<health::FrameReport> process_first(const RgbdFrame& frame,
                                                          RestartableEstimator& estimator);
  [[nodiscard]] bool is_false_start(const health::FrameReport& report);

  const config::InitialisationConfig& config_;
  std::optional<RgbdFrame> first_frame_;  ///< until the second one was processed
  bool confirmed_ = false;                ///< enough frames were tracked after the first one
  int lost_frames_ = 0;                   ///< since the first one
  int tracked_frames_ = 0;                ///< the same
};

}  // namespace fusebench::core
