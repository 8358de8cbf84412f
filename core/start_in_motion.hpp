// A recording that starts in motion starts with a velocity that nobody knows. The first two frames tell it,
// so they are processed again with it: the first one is then compensated properly, and the second one
// predicted well. Not in the paper.
#pragma once

#include <optional>

#include "core/error.hpp"
#include "core/filter_state.hpp"
#include "core/frame_report.hpp"
#include "core/types.hpp"

namespace fusebench {

/// An estimator that can begin again.
class RestartableEstimator {
 public:
  RestartableEstimator() = default;
  RestartableEstimator(const RestartableEstimator&) = delete;
  RestartableEstimator& operator=(const RestartableEstimator&) = delete;
  virtual ~RestartableEstimator() = default;

  [[nodiscard]] virtual Result<FrameReport> process_frame(const RgbdFrame& frame) = 0;
  /// The state after the last frame; nothing before the first one that could be used.
  [[nodiscard]] virtual const std::optional<GaussianState>& estimate() const = 0;
  /// Forgets all frames, to begin with the velocities of this state.
  virtual void restart(const FilterState& motion) = 0;
};

class StartInMotion {
 public:
  /// Processes the next frame; the second one that can be used together with the first one again. Its report
  /// has the time of all of that.
  [[nodiscard]] Result<FrameReport> process(const RgbdFrame& frame, RestartableEstimator& estimator);

 private:
  std::optional<RgbdFrame> first_frame_;  ///< until the second one was processed
};

}  // namespace fusebench
