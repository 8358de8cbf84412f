// Pyramids of a frame and of a view of the model; each level has half the size: pixel (x, y) of level l is at
// (x, y) * 2^l of the image.
#pragma once

#include <array>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/elasticfusion/surfels/live_frame.hpp"
#include "core/baselines/elasticfusion/surfels/surfel_view.hpp"
#include "core/baselines/image_gradient.hpp"
#include "core/baselines/point_map.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

inline constexpr int kLevels = 3;

/// The camera of a level.
[[nodiscard]] PinholeCamera camera_of_level(const PinholeCamera& camera, int level);

/// Half the size: binomial means over 5x5 pixels of those measured within 9 cm of the central one.
[[nodiscard]] DepthImage half_depth(const DepthImage& depth_m);

struct LiveLevel {
  PinholeCamera camera;
  DepthImage depth_m;  ///< smoothed
  PointMap normal;     ///< camera frame; 0 if there is none
  Image<float> intensity;
  Gradient gradient;
};
using LivePyramid = std::array<LiveLevel, kLevels>;
[[nodiscard]] LivePyramid live_pyramid(const surfels::LiveFrame& live, const PinholeCamera& camera,
                                       const Workers& workers);
/// Pyramid of a view of the model that replaces a frame. Holes have no intensity: they are excluded from
/// means, and the gradient next to them is zero. As published, they are black.
[[nodiscard]] LivePyramid live_pyramid(const surfels::SurfelView& view, config::PeerDefects defects,
                                       const Workers& workers);

/// Points of a level can be means of several, so they are not exactly on the rays of the pixels.
struct ViewLevel {
  PinholeCamera camera;
  PointMap point;   ///< camera frame; z = 0 if there is none
  PointMap normal;  ///< unit
  Image<float> intensity;
  DepthImage depth_m;  ///< z along the ray of each pixel; 0 if there is none
};
using ViewPyramid = std::array<ViewLevel, kLevels>;
/// Points and normals are means of four valid ones. Intensities are means of what the camera sees alone,
/// without the holes. Corrected or as published: the weights of colour.
[[nodiscard]] ViewPyramid view_pyramid(const surfels::SurfelView& view, config::PeerDefects defects);

}  // namespace fusebench::baselines::elasticfusion::tracking
