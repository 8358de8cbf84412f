// Compensation of the motion within a frame. Rows of a rolling shutter are exposed one after the other, and
// depth may have another instant than colour. A fast rotation shears the image and misaligns depth and
// colour. Panning at 100 deg/s with a read-out of 26 ms shears a VGA image by 24 pixels, in opposite
// directions on the way there and back, which no rigid motion can explain. The paper does not treat it.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::preprocessing {

/// Motion of the camera around a frame, constant over it; camera axes at the frame's instant.
struct CameraVelocity {
  Vector3d angular_radps = Vector3d::Zero();
  Vector3d linear_mps = Vector3d::Zero();
};

/// Read-out times of the images of a frame, relative to its instant.
struct FrameTiming {
  double color_readout_s = 0;
  double depth_readout_s = 0;
  double depth_delay_s = 0;  ///< of the middle row of depth

  /// True if there is nothing to compensate.
  [[nodiscard]] bool is_one_instant() const {
    return color_readout_s == 0 && depth_readout_s == 0 && depth_delay_s == 0;
  }
};

/// Timing of a frame from its stamps and its rig.
[[nodiscard]] FrameTiming frame_timing(const RgbdFrame& frame, const SensorTiming& timing);

/// Depth and grey of the frame as by a global shutter at frame.capture_ns().
/// Row v was read (v / (height - 1) - 1/2) * read-out after the instant of its image. Depth is taken from the
/// nearest pixel and transformed to the instant of the frame. Grey is interpolated bilinearly at the position
/// for this depth (infinite depth if there is none). Pixels with a source outside the image get depth 0 and
/// the nearest border grey. Images have at least 8 columns and 2 rows.
/// Error of positions: 0.01 pixels for hand-held motion (1 rad/s, 0.5 m/s), some 0.1 pixels in the corners at
/// three times that speed. `result` must be another frame; its memory is reused and its colour is unchanged.
void compensate_motion(const RgbdFrame& frame, const PinholeCamera& camera, const FrameTiming& timing,
                       const CameraVelocity& velocity, const Workers& workers, RgbdFrame& result);

/// Compensates the colour of the frame, given its compensated depth (infinite depth if there is none). Empty
/// if the frame has no colour. Separate, since tracking does not need colour.
void compensate_color(const RgbdFrame& frame, const PinholeCamera& camera, const FrameTiming& timing,
                      const CameraVelocity& velocity, const DepthImage& depth_m, const Workers& workers,
                      ColorImage& result);

}  // namespace fusebench::preprocessing
