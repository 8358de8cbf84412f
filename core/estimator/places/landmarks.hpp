// Features with depth, for the recognition of a place and its relative pose.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/place_features.hpp"

namespace fusebench::places {

struct Landmarks {
  std::vector<PlaceFeature> features;   ///< features with depth
  std::vector<Vector3d> points_camera;  ///< one for each feature, camera axes, metres
};

/// The landmarks in a frame; depth in metres, 0 = none.
[[nodiscard]] Landmarks landmarks_of(const GreyImage& grey, const DepthImage& depth_m,
                                     const PinholeCamera& camera, const config::PlaceFeaturesConfig& features,
                                     const config::RelocalisationConfig& relocalisation);

/// The landmarks in the half-size image of the frame, if it is at least 320 pixels wide; at most `max_count`.
/// A quarter of the work, and less sensitive to blur.
[[nodiscard]] Landmarks coarse_landmarks_of(const GreyImage& grey, const DepthImage& depth_m,
                                            const PinholeCamera& camera, int max_count,
                                            const config::PlaceFeaturesConfig& features,
                                            const config::RelocalisationConfig& relocalisation);

/// The depth of a feature; 0 at a depth edge, where it may be that of the background.
[[nodiscard]] double landmark_depth_m(const DepthImage& depth_m, const Vector2d& pixel_px,
                                      const config::RelocalisationConfig& config);

}  // namespace fusebench::places
