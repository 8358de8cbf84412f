// Intensities of a frame against those that a camera sees of the model.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/systems/elasticfusion/tracking/pyramids.hpp"
#include "core/systems/pose_sums.hpp"

namespace fusebench::systems::elasticfusion::tracking {

/// The pixels of a level that tell something: their gradient is large enough, and they have depth. One number
/// of each a pixel, in rows of eight; those beyond the last pixel have no depth.
struct TellingPixels {
  PinholeCamera camera;
  std::vector<float> x;  ///< of the point, camera frame
  std::vector<float> y;
  std::vector<float> z;
  std::vector<float> dx;  ///< gradient, per pixel
  std::vector<float> dy;
  std::vector<float> intensity;
};

/// Those whose gradient is at least so long (grey levels per pixel), nearer than 6 m.
[[nodiscard]] TellingPixels telling_pixels(const LiveLevel& live, double min_gradient);

/// Sums over the pixels that have a match: each is moved into the view's camera, and the model's point there,
/// if its depth is within 7 cm, is seen from the frame. The model's intensity is interpolated between four
/// pixels, as the article's continuous image of the model has it; as published it is that of the nearest
/// pixel. Residuals weigh 1 / (s + |r|), where s is the root of their mean square, or as published of their
/// number, in the cost as well. Steps as of match_planes().
[[nodiscard]] PoseSums match_intensities(const TellingPixels& pixels, const ViewLevel& view,
                                         const SE3& T_view_camera, config::PeerDefects defects,
                                         const Workers& workers);

}  // namespace fusebench::systems::elasticfusion::tracking
