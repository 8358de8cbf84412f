// Intensities of a frame against those that a camera sees of the model.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/config/config.hpp"
#include "core/systems/elasticfusion/tracking/pyramids.hpp"
#include "core/systems/pose_sums.hpp"

namespace fusebench::systems::elasticfusion::tracking {

/// A pixel of a frame that tells something: its gradient is large enough, and it has depth.
struct TellingPixel {
  float intensity;
  Eigen::Vector2f gradient;  ///< per pixel
  Eigen::Vector3f point;     ///< camera frame
};

/// Those of a level whose gradient is at least so long (grey levels per pixel), nearer than 6 m.
[[nodiscard]] std::vector<TellingPixel> telling_pixels(const LiveLevel& live, double min_gradient);

/// Sums over the pixels that have a match: each is moved into the view's camera, and the model's point at the
/// nearest pixel, if its depth is within 7 cm, is seen from the frame. Residuals weigh 1 / (s + |r|), where s
/// is the root of their mean square, or as published of their number. Steps as of match_planes().
[[nodiscard]] PoseSums match_intensities(const std::vector<TellingPixel>& pixels, const PinholeCamera& camera,
                                         const ViewLevel& view, const SE3& T_view_camera,
                                         config::PeerDefects defects, const Workers& workers);

}  // namespace fusebench::systems::elasticfusion::tracking
