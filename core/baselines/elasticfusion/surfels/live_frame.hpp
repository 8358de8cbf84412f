// A frame prepared for model and tracker.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/point_map.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

struct LiveFrame {
  DepthImage raw_m;     ///< within the depth limits; positions of surfels
  DepthImage smooth_m;  ///< smoothed raw_m; used for tracking and normals
  PointMap normal;      ///< camera frame, unit, towards the camera; 0 if there is none
  ColorImage color;
  GreyImage grey;  ///< weighted as the options require
};

/// Normals of a depth image by differences over one pixel to either side; 0 if one of the five pixels has no
/// measurement.
[[nodiscard]] PointMap normals_of(const DepthImage& depth_m, const PinholeCamera& camera,
                                  const Workers& workers);

[[nodiscard]] LiveFrame make_live_frame(const RgbdFrame& frame, const PinholeCamera& camera,
                                        const config::DepthConfig& depth, config::PeerDefects defects,
                                        const Workers& workers);

/// Intensity of colour. The published program exchanges the weights of red and blue.
[[nodiscard]] GreyImage intensity_of(const ColorImage& color, config::PeerDefects defects);

}  // namespace fusebench::baselines::elasticfusion::surfels
