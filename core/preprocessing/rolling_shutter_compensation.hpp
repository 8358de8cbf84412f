// Motion within a frame. Rows of a rolling shutter are exposed one after the other, and depth may be taken at
// another instant than colour: a camera that turns fast records a sheared scene, with depth that is not
// aligned with its colour. Panning at 100 deg/s with 26 ms of read-out shears a VGA image by 24 pixels, one
// way on the way there and the other way on the way back, which no rigid motion can explain. The paper does
// not treat it.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::preprocessing {

/// Motion of the camera around a frame, constant over it; camera axes at the frame's instant.
struct CameraVelocity {
  Vector3d angular_radps = Vector3d::Zero();
  Vector3d linear_mps = Vector3d::Zero();
};

/// When the images of a frame were read, after the frame's instant.
struct FrameTiming {
  double color_readout_s = 0;
  double depth_readout_s = 0;
  double depth_delay_s = 0;  ///< of the middle row of depth

  /// True if there is nothing to compensate.
  [[nodiscard]] bool is_one_instant() const {
    return color_readout_s == 0 && depth_readout_s == 0 && depth_delay_s == 0;
  }
};

/// As the frame and its rig say.
[[nodiscard]] FrameTiming frame_timing(const RgbdFrame& frame, const SensorTiming& timing);

/// Depth and grey of the frame as a global shutter at frame.capture_ns() would have seen them. Row v of an
/// image was read (v / (height - 1) - 1/2) * read-out after the image's own instant. Depth is taken from the
/// nearest pixel and carried to the frame's instant; grey is interpolated bilinearly at the position given by
/// the carried depth (infinite depth where there is none). Pixels whose source lies outside the image keep
/// depth 0 and the nearest border grey, so that nothing uses them. Images have at least 8 columns and 2 rows.
/// Places are good to a hundredth of a pixel for motion as of a hand (1 rad/s, 0.5 m/s), to some tenths in
/// corners at thrice that. `result` is another frame, whose memory is used again; its colour is left alone.
void compensate_motion(const RgbdFrame& frame, const PinholeCamera& camera, const FrameTiming& timing,
                       const CameraVelocity& velocity, const Workers& workers, RgbdFrame& result);

/// The same for the colour of the frame, by depth that was compensated already (where there is none, as if
/// far away); empty if the frame has none. Apart because tracking needs none.
void compensate_color(const RgbdFrame& frame, const PinholeCamera& camera, const FrameTiming& timing,
                      const CameraVelocity& velocity, const DepthImage& depth_m, const Workers& workers,
                      ColorImage& result);

}  // namespace fusebench::preprocessing
