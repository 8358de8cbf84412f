// Estimates how much the pose by colour drifts against the model.
//
// A photometric residual measures the motion since the last fused frame. Errors that all patches share (depth
// not registered to colour, wrong focal length, distortion, rolling shutter) do not appear in the scatter of
// the patches. The filter then underestimates its uncertainty: depth corrects the pose in the same direction
// in every frame, by too little, and the map drifts.
//
// In a consistent filter the corrections by one measurement are white (innovations: Kailath 1968; tuning by
// their correlation: Mehra 1970). Here the covariance of corrections that are lag_frames apart is added to
// the variance of the reference pose in each frame. Neither noise nor a single jolt contributes to it.
#pragma once

#include <vector>

#include "core/base/geometry.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::filter {

/// Standard deviations by axis that colour adds to the pose of the patches in each frame.
struct ReferenceNoise {
  double rotation_rad = 0;
  double translation_m = 0;
};

class ColorDrift {
 public:
  /// correction_imu: motion of the pose by the depth measurement of an updated frame (rotation in rad,
  /// translation in m, both along the axes of the IMU).
  void observe(const Vector6d& correction_imu, const config::ColorDriftConfig& config);

  [[nodiscard]] ReferenceNoise noise(const config::ColorDriftConfig& config) const;

 private:
  std::vector<Vector6d> corrections_;  ///< ring buffer of the last lag_frames corrections
  std::size_t oldest_ = 0;
  double rotation_covariance_rad2_ = 0;  ///< covariance of corrections lag_frames apart, by axis
  double translation_covariance_m2_ = 0;
};

}  // namespace fusebench::filter
