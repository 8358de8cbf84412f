// Intrinsics that a recording gives for each frame, since its camera refocuses.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/types.hpp"

namespace fusebench::calibration {

struct FrameCamera {
  std::int64_t frame = 0;  ///< its number in the recording's files
  PinholeCamera camera;
};

/// One camera for all frames.
struct CommonCamera {
  PinholeCamera camera;
  std::string change;  ///< by how much the focal length changes, and in which frames; empty if not by 0.5 %
};

/// The medians of fx, fy, cx and cy; the size is that of the first. frames must not be empty.
[[nodiscard]] CommonCamera common_camera(std::span<const FrameCamera> frames);

}  // namespace fusebench::calibration
