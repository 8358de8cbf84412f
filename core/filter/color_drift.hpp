// How much the pose by colour drifts against the model.
//
// A photometric residual measures the motion since the last fused frame. What all patches have in common
// there (depth that is not registered to the colour image, another focal length, a lens, rows read one after
// the other) does not show in their scatter, so the filter takes the motion for better known than it is:
// depth then corrects the same way in frame after frame, too little each time, and the map drifts. In a
// consistent filter the corrections of one measurement are uncorrelated in time (innovations are white:
// Kailath 1968; tuning by their correlation: Mehra 1970). Here the covariance of corrections some frames
// apart, which neither noise nor a single jolt has, is the variance that the reference pose gains in each
// frame.
#pragma once

#include <vector>

#include "core/base/geometry.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::filter {

/// Standard deviations by axis of the pose that patches are cut at, as seen by colour, in each frame.
struct ReferenceNoise {
  double rotation_rad = 0;
  double translation_m = 0;
};

class ColorDrift {
 public:
  /// Of an updated frame: how the measurement by depth moved the pose (rotation in rad, translation in m,
  /// both along the axes of the IMU).
  void observe(const Vector6d& correction_imu, const config::ColorDriftConfig& config);

  [[nodiscard]] ReferenceNoise noise(const config::ColorDriftConfig& config) const;

 private:
  std::vector<Vector6d> corrections_;  ///< the last lag_frames, in a ring
  std::size_t oldest_ = 0;
  double rotation_covariance_rad2_ = 0;  ///< of corrections lag_frames apart, by axis
  double translation_covariance_m2_ = 0;
};

}  // namespace fusebench::filter
