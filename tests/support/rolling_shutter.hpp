// The textured room as a rolling shutter sees it: each row with the pose of the camera at the row's own time.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/types.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench::testing {

/// pose_after(seconds) is T_world_camera that long after the colour image's instant. Depth is taken
/// timing.depth_delay_s later and says so. The stamp is 0.
template <class PoseAfter>
RgbdFrame render_rolling(const TexturedRoom& room, const PinholeCamera& camera, const SensorTiming& timing,
                         const PoseAfter& pose_after) {
  RgbdFrame frame;
  frame.depth_offset_ns = static_cast<std::int64_t>(std::llround(1e9 * timing.depth_delay_s));
  frame.color = ColorImage(camera.width_px, camera.height_px);
  frame.depth_m = DepthImage(camera.width_px, camera.height_px);
  for (int y = 0; y < camera.height_px; ++y) {
    const double row = static_cast<double>(y) / (camera.height_px - 1) - 0.5;
    const SE3 color_pose = pose_after(row * timing.color_readout_s);
    const SE3 depth_pose = pose_after(timing.depth_delay_s + row * timing.depth_readout_s);
    for (int x = 0; x < camera.width_px; ++x) {
      const std::uint8_t level = room.look(camera, color_pose, x, y).level;
      frame.color(x, y) = {level, level, level};
      frame.depth_m(x, y) = room.look(camera, depth_pose, x, y).depth_m;
    }
  }
  frame.grey = to_grey(frame.color);
  return frame;
}

}  // namespace fusebench::testing
