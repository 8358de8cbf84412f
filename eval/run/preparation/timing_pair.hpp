// What two frames say of the timing of the image sensors.
//
// A rolling shutter distorts an image by the motion of the camera while it is read: rows above the middle
// were read before the frame's instant, rows below after it. Two frames that see the same surfaces while the
// camera moved at different velocities are distorted differently, and that difference, which no pose
// explains, is proportional to the read-out. A delay of depth against colour shows likewise: the pose between
// the depth images differs from that between the colour images by the delay times the difference of the
// velocities.
//
// Points of the first frame are warped into the second one, each at the instant of its row:
//
//   X_b = Exp(-xi_b s_b) T_b_a Exp(xi_a s_a) X_a,   colour: s = tau_c rho,   depth: s = delta + tau_d rho
//
// with rho the row from the middle as a share of the image's height and xi the velocities (twists).
// Residuals: grey levels up to a gain and an offset; distances of depth to its planes. Pose, gain and offset
// are of the pair, and eliminated; what is left is a quadratic in the timing.
#pragma once

#include <optional>

#include "core/base/types.hpp"
#include "eval/run/preparation/moving_frame.hpp"

namespace fusebench::preparation {

/// Cost of a pair as a function of the timing (read-out of colour, read-out of depth, delay of depth;
/// seconds): information and gradient at the one it was taken at, in units of the pair's own residuals
/// (robust).
struct TimingQuadratic {
  Matrix3d information = Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
};

/// Both frames have a motion. timing_s: colour's read-out, depth's read-out, and the delay of depth beyond
/// depth_offset_ns. Nothing if the frames have too little in common, or if their images do not fit.
[[nodiscard]] std::optional<TimingQuadratic> timing_of_pair(const MovingFrame& a, const MovingFrame& b,
                                                            const PinholeCamera& camera,
                                                            const Vector3d& timing_s);

}  // namespace fusebench::preparation
