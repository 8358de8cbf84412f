// A frame as the model and the tracker need it.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/systems/point_map.hpp"

namespace fusebench::systems::elasticfusion::surfels {

struct LiveFrame {
  DepthImage raw_m;     ///< within the limits of depth; where surfels are
  DepthImage smooth_m;  ///< the same without noise: what is tracked, and what normals are of
  PointMap normal;      ///< in the camera's frame, unit, towards it; 0 where there is none
  ColorImage color;
  GreyImage grey;  ///< by the weights of the options
};

/// Normals of a depth image by differences over a pixel either way; 0 where one of the four or the pixel
/// itself was not measured.
[[nodiscard]] PointMap normals_of(const DepthImage& depth_m, const PinholeCamera& camera,
                                  const Workers& workers);

[[nodiscard]] LiveFrame make_live_frame(const RgbdFrame& frame, const PinholeCamera& camera,
                                        const config::DepthConfig& depth, config::PeerDefects defects,
                                        const Workers& workers);

/// Intensity of colour. As published, red and blue have each other's weight.
[[nodiscard]] GreyImage intensity_of(const ColorImage& color, config::PeerDefects defects);

}  // namespace fusebench::systems::elasticfusion::surfels
