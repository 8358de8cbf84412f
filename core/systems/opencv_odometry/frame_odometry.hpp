// The motion between two frames by OpenCV's odometries (module rgbd).
#pragma once

#include <memory>
#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::systems::opencv_odometry {

/// Keeps one frame, and finds the motion to it. As the library's own example uses it: the pyramids of a frame
/// serve for two pairs, and pixels without depth are NaN.
class FrameOdometry {
 public:
  FrameOdometry(config::OdometryMethod method, const PinholeCamera& camera);
  ~FrameOdometry();

  /// Takes the next frame; its images are copied.
  void receive(const RgbdFrame& frame);
  /// T_kept_received, of the frame that is kept and the one that was received last; nothing if the library
  /// finds no motion, or nothing is kept.
  [[nodiscard]] std::optional<SE3> motion();
  [[nodiscard]] bool keeps_one() const;
  /// Keeps the frame that was received last in place of the one before.
  void keep_received();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::systems::opencv_odometry
