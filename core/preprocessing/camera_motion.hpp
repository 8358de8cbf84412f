// The motion of the camera as the state of the IMU that it is mounted to gives it.
#pragma once

#include "core/base/types.hpp"
#include "core/filter/filter_state.hpp"
#include "core/preprocessing/rolling_shutter_compensation.hpp"

namespace fusebench::preprocessing {

/// Velocities of the camera in its own axes, lever arm included.
[[nodiscard]] CameraVelocity camera_velocity(const filter::FilterState& state, const SE3& T_imu_camera);

/// The timing of a frame as the rig says and the state corrects it.
[[nodiscard]] FrameTiming estimated_timing(const RgbdFrame& frame, const SensorTiming& timing,
                                           const filter::SensorErrors& errors);

/// Length of the motion blur at the image centre, by rotation alone (the depth is not known yet), pixels.
[[nodiscard]] double predicted_blur_px(const filter::FilterState& state, const SensorRig& rig,
                                       double exposure_s);

/// By how much a motion may differ from the one that a frame was compensated for.
struct VelocityTolerance {
  double angular_radps = 0;
  double linear_mps = 0;
};

/// True if a frame that was compensated for the motion before is off by too much for that of now.
[[nodiscard]] bool velocity_changed_much(const filter::FilterState& before, const filter::FilterState& now,
                                         const VelocityTolerance& tolerance);

}  // namespace fusebench::preprocessing
