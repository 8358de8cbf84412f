// Small images of a recording, and the motion of the camera that took them, as the images alone tell it.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/parallel.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::preparation {

/// Pose and velocity of the camera at the instant of a colour image.
struct CameraMotion {
  SE3 T_world_camera;
  Vector6d twist = Vector6d::Zero();  ///< angular (rad/s) and linear velocity (m/s), in the camera's axes
};

struct MovingFrame {
  RgbdFrame frame;                     ///< without the colour image
  std::optional<CameraMotion> motion;  ///< nothing where it is not known
};

/// Consecutive frames at a fraction of their resolution.
struct MovingFrames {
  PinholeCamera camera;  ///< of the small images
  std::vector<MovingFrame> frames;
};

/// Frames `begin` to `end` - 1, every 2^n-th pixel, so that they are at most 320 pixels wide (grey filtered,
/// build_pyramid()), with the poses of variant `no-imu`. Velocities are the derivative of the polynomial
/// through the poses of five frames; a frame has a motion if all five are tracked in the map. Errors: those
/// of reading a frame, run_failed (stopped).
[[nodiscard]] Result<MovingFrames> moving_frames(const recording::Recording& recording, std::size_t begin,
                                                 std::size_t end, const Workers& workers,
                                                 const std::atomic<bool>* stop);

}  // namespace fusebench::preparation
