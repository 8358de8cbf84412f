// Motion of the camera from the state of its IMU.
#pragma once

#include "core/base/types.hpp"
#include "core/estimator/filter/filter_state.hpp"
#include "core/estimator/preprocessing/rolling_shutter_compensation.hpp"

namespace fusebench::preprocessing {

/// Velocities of the camera in its own axes, including the lever arm.
[[nodiscard]] CameraVelocity camera_velocity(const filter::FilterState& state, const SE3& T_imu_camera);

/// Timing of a frame: that of the rig plus the corrections of the state.
[[nodiscard]] FrameTiming estimated_timing(const RgbdFrame& frame, const SensorTiming& timing,
                                           const filter::SensorErrors& errors);

/// Length of the motion blur at the image centre in pixels, by rotation alone (the depth is not given here).
[[nodiscard]] double predicted_blur_px(const filter::FilterState& state, const SensorRig& rig,
                                       double exposure_s);

/// Allowed difference between the motion of a frame and the motion it was compensated for.
struct VelocityTolerance {
  double angular_radps = 0;
  double linear_mps = 0;
};

/// True if the difference between the compensated motion `before` and the motion `now` exceeds the tolerance.
[[nodiscard]] bool velocity_changed_much(const filter::FilterState& before, const filter::FilterState& now,
                                         const VelocityTolerance& tolerance);

}  // namespace fusebench::preprocessing
