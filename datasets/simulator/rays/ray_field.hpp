// Ray directions of the pixels of a camera.
#pragma once

#include <span>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "datasets/calibration/camera_model.hpp"

namespace fusebench::simulator::rays {

/// Directions on the plane z = 1 of the camera. With distortion, they are solved at the corners between
/// pixels and interpolated (error below 1e-4 pixels for the calibrations in use). Images are rendered along
/// the distorted rays instead of being resampled.
class RayField {
 public:
  explicit RayField(const PinholeCamera& camera) : camera_(camera) {}
  RayField(const calibration::CalibratedCamera& camera, const Workers& workers);

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }

  /// x and y of the directions of row v at (u + offset.x, v + offset.y); with distortion, offsets are within
  /// half a pixel. The spans have the width of the camera.
  void row(int v, const Vector2d& offset_px, std::span<float> x, std::span<float> y) const;

 private:
  PinholeCamera camera_;
  Image<float> corners_x_;  // as corners_y_: (width + 1) x (height + 1); empty without distortion
  Image<float> corners_y_;
};

}  // namespace fusebench::simulator::rays
