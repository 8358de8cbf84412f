// Depth sensors match patterns of light in images of 640 columns, whatever the size of the depth image that
// they deliver. What their models say in pixels (errors of disparity, windows) is in these.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

/// Columns of the sensor for one of the image: 1 at 640 columns, 2 at 320.
[[nodiscard]] inline double native_per_image_px(const PinholeCamera& camera) {
  return 640.0 / camera.width_px;
}

/// A length of the sensor's pixels in those of the image, at least 1.
[[nodiscard]] inline int image_px(int native_px, const PinholeCamera& camera) {
  return std::max(1, static_cast<int>(std::lround(native_px / native_per_image_px(camera))));
}

/// Disparity times depth, in pixels of the sensor times metres.
[[nodiscard]] inline float focal_baseline_px_m(const PinholeCamera& camera, double baseline_m) {
  return static_cast<float>(camera.fx_px * native_per_image_px(camera) * baseline_m);
}

}  // namespace fusebench::simulator::sensors
