// Motion between two frames by OpenCV's odometries (module rgbd).
#pragma once

#include <memory>
#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::opencv_odometry {

/// Stores a reference frame and estimates the motion to it. As in the example of the library, the pyramids of
/// a frame are used for two pairs, and pixels without depth are NaN.
class FrameOdometry {
 public:
  FrameOdometry(config::OdometryMethod method, const PinholeCamera& camera);
  ~FrameOdometry();

  /// Takes the next frame; its images are copied.
  void receive(const RgbdFrame& frame);
  /// T_kept_received between the kept and the last received frame; nothing if the library fails or no frame
  /// is kept.
  [[nodiscard]] std::optional<SE3> motion();
  [[nodiscard]] bool keeps_one() const;
  /// Keeps the last received frame instead of the previous one.
  void keep_received();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fusebench::baselines::opencv_odometry
