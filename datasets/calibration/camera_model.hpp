// Lens distortion and its removal.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "datasets/calibration/bilinear_map.hpp"

namespace fusebench::calibration {

/// A timing that nobody said. Rows are read all at once (a global shutter) or during any part of a frame's
/// time, which is 33 ms at 30 Hz: about the mean and standard deviation of that range.
inline constexpr double kUnknownReadout_s = 0.015;
inline constexpr double kUnknownReadoutSigma_s = 0.01;
inline constexpr double kUnknownDelaySigma_s = 0.01;  ///< around none
inline constexpr SensorTiming kUnknownTiming{
    kUnknownReadout_s,      kUnknownReadout_s,      0,
    kUnknownReadoutSigma_s, kUnknownReadoutSigma_s, kUnknownDelaySigma_s};

/// Brown-Conrady distortion (OpenCV's "plumb bob", five coefficients) on the plane z = 1:
///   x_d = x (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 x y + p2 (r2 + 2 x^2),  r2 = x^2 + y^2
///   y_d = y (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 y^2) + 2 p2 x y
struct BrownConrady {
  double k1 = 0;
  double k2 = 0;
  double p1 = 0;
  double p2 = 0;
  double k3 = 0;

  [[nodiscard]] bool is_zero() const { return k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0; }

  /// Ideal to distorted coordinates on the plane z = 1.
  [[nodiscard]] Vector2d distort(const Vector2d& ideal) const;

  /// Inverse of distort() by Newton's method. Meaningful where the model is monotonic, i.e. within the image.
  [[nodiscard]] Vector2d undistort(const Vector2d& distorted) const;
};

/// A camera as its calibration describes it. pinhole.width_px = 0: the size is that of the images.
struct CalibratedCamera {
  PinholeCamera pinhole;
  BrownConrady distortion;
  SensorTiming timing;
  /// Of the optical centre, in the frame of the body whose poses the ground truth gives.
  Vector3d ground_truth_offset_m = Vector3d::Zero();
};

/// Resamples distorted images to the pinhole camera with the same intrinsics and size.
///
/// Colour is interpolated bilinearly in fixed point (1/32 pixel), so the result is the same on every machine.
/// Depth takes the nearest measurement: interpolation would invent surfaces between foreground and
/// background. A pixel whose source lies outside of the image has depth 0, so nothing uses it as a
/// measurement, and the colour of the nearest border pixel: black would put a strong false edge into the
/// image.
class Undistortion {
 public:
  /// camera.pinhole must have its size.
  explicit Undistortion(const CalibratedCamera& camera);

  /// Images must have the size of the camera (checked).
  [[nodiscard]] ColorImage undistort_color(const ColorImage& distorted) const;
  [[nodiscard]] DepthImage undistort_depth(const DepthImage& distorted_m) const;

  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }

 private:
  PinholeCamera camera_;
  bool identity_ = false;
  BilinearMap color_;
  std::vector<std::int32_t> nearest_;  ///< index of the nearest source pixel, -1 outside
};

}  // namespace fusebench::calibration
