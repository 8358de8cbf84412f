// Registration of the intensities of a frame with those of a view of the model.
#pragma once

#include <vector>

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/tracking/pyramids.hpp"
#include "core/baselines/pose_sums.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

/// The pixels of a level with sufficient gradient and depth, as arrays in rows of eight; padding has no
/// depth.
struct TellingPixels {
  PinholeCamera camera;
  std::vector<float> x;  ///< of the point, camera frame
  std::vector<float> y;
  std::vector<float> z;
  std::vector<float> dx;  ///< gradient, per pixel
  std::vector<float> dy;
  std::vector<float> intensity;
};

/// Selects the pixels with at least this gradient (grey levels per pixel) and a depth below 6 m.
[[nodiscard]] TellingPixels telling_pixels(const LiveLevel& live, double min_gradient);

/// Sums over the pixels with a match. Each is projected into the view; it matches if its depth differs by
/// less than 7 cm from the model's point there and that point is visible in the frame. The intensity of the
/// model is interpolated bilinearly, as in the article; as published it is that of the nearest pixel. The
/// weight of a residual is 1 / (s + |r|), with s the root mean square of the residuals (as published: the
/// root of their number, in the cost as well). Tangent of the step as match_planes().
[[nodiscard]] PoseSums match_intensities(const TellingPixels& pixels, const ViewLevel& view,
                                         const SE3& T_view_camera, config::PeerDefects defects,
                                         const Workers& workers);

}  // namespace fusebench::baselines::elasticfusion::tracking
