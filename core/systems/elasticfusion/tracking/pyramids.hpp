// Levels of a frame and of a view of the model, each half the size of the one before: pixel (x, y) of level l
// lies at (x, y) * 2^l of the image.
#pragma once

#include <array>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/systems/elasticfusion/surfels/live_frame.hpp"
#include "core/systems/elasticfusion/surfels/surfel_view.hpp"
#include "core/systems/image_gradient.hpp"
#include "core/systems/point_map.hpp"

namespace fusebench::systems::elasticfusion::tracking {

inline constexpr int kLevels = 3;

/// The camera of a level.
[[nodiscard]] PinholeCamera camera_of_level(const PinholeCamera& camera, int level);

/// Half the size: binomial means over 5x5 pixels, of the measured ones within 9 cm of the middle one.
[[nodiscard]] DepthImage half_depth(const DepthImage& depth_m);

struct LiveLevel {
  PinholeCamera camera;
  DepthImage depth_m;  ///< smooth
  PointMap normal;     ///< camera frame; 0 where there is none
  Image<float> intensity;
  Gradient gradient;
};
using LivePyramid = std::array<LiveLevel, kLevels>;
[[nodiscard]] LivePyramid live_pyramid(const surfels::LiveFrame& live, const PinholeCamera& camera,
                                       const Workers& workers);
/// Of a view of the model that stands in for a frame. Its holes have no intensity: nothing is averaged over
/// them, and beside them there is no gradient. As published, they are black.
[[nodiscard]] LivePyramid live_pyramid(const surfels::SurfelView& view, config::PeerDefects defects,
                                       const Workers& workers);

/// Its points may be means of several, so that they do not lie on the rays of the pixels.
struct ViewLevel {
  PinholeCamera camera;
  PointMap point;   ///< camera frame; z is 0 where there is none
  PointMap normal;  ///< unit
  Image<float> intensity;
  DepthImage depth_m;  ///< of the ray of each pixel; 0 where there is none
};
using ViewPyramid = std::array<ViewLevel, kLevels>;
/// Points and normals are means of four that are all there. Intensities are means of what the camera sees
/// alone, without the holes. Fixed or as published: the weights of colour.
[[nodiscard]] ViewPyramid view_pyramid(const surfels::SurfelView& view, config::PeerDefects defects);

}  // namespace fusebench::systems::elasticfusion::tracking
