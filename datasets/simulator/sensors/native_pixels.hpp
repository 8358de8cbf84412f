// The pixels in which a depth sensor matches patterns of light: what its model says in pixels (errors of
// disparity, windows) is in these. A Kinect matches in 640 columns and leaves out pixels for a smaller image;
// an R200 or ZR300 matches in the size that it delivers, which is why it measures nearer in a smaller image
// (librealsense v1.12.1, doc/camera_specs.md).
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

class NativePixels {
 public:
  /// columns: of the sensor, over the width of the image.
  NativePixels(const PinholeCamera& camera, int columns)
      : fx_px_(camera.fx_px), per_image_px_(static_cast<double>(columns) / camera.width_px) {}

  /// Columns of the sensor for one of the image.
  [[nodiscard]] double per_image_px() const { return per_image_px_; }
  /// A length of the sensor's pixels in those of the image, at least 1.
  [[nodiscard]] int in_image(int native_px) const {
    return std::max(1, static_cast<int>(std::lround(native_px / per_image_px_)));
  }
  /// Disparity times depth, in pixels of the sensor times metres.
  [[nodiscard]] float focal_baseline_px_m(double baseline_m) const {
    return static_cast<float>(fx_px_ * per_image_px_ * baseline_m);
  }

 private:
  double fx_px_;
  double per_image_px_;
};

}  // namespace fusebench::simulator::sensors
