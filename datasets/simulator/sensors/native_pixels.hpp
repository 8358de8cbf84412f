// Native pixels of a depth sensor, in which its error model is defined (disparity errors, windows). A Kinect
// matches at 640 columns and skips pixels for smaller images. An R200 or ZR300 matches at the output size, so
// it measures nearer in smaller images (librealsense v1.12.1, doc/camera_specs.md).
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

class NativePixels {
 public:
  /// columns: width of the sensor that corresponds to the width of the image.
  NativePixels(const PinholeCamera& camera, int columns)
      : fx_px_(camera.fx_px), per_image_px_(static_cast<double>(columns) / camera.width_px) {}

  /// Sensor columns per image column.
  [[nodiscard]] double per_image_px() const { return per_image_px_; }
  /// Converts a length from sensor pixels to image pixels, at least 1.
  [[nodiscard]] int in_image(int native_px) const {
    return std::max(1, static_cast<int>(std::lround(native_px / per_image_px_)));
  }
  /// Disparity * depth, in sensor pixels * metres.
  [[nodiscard]] float focal_baseline_px_m(double baseline_m) const {
    return static_cast<float>(fx_px_ * per_image_px_ * baseline_m);
  }

 private:
  double fx_px_;
  double per_image_px_;
};

}  // namespace fusebench::simulator::sensors
