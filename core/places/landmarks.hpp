// Features with depth, by which a place is recognised and by which it tells a pose.
#pragma once

#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/places/place_features.hpp"

namespace fusebench::places {

struct Landmarks {
  std::vector<PlaceFeature> features;   ///< those with depth
  std::vector<Vector3d> points_camera;  ///< one a feature, in the camera's axes, metres
};

/// The landmarks in a frame; depth in metres, 0 = none.
[[nodiscard]] Landmarks landmarks_of(const GreyImage& grey, const DepthImage& depth_m,
                                     const PinholeCamera& camera, const config::PlaceFeaturesConfig& features,
                                     const config::RelocalisationConfig& relocalisation);

/// The landmarks in the frame's image of half the size, if that is not less than 320 pixels wide, at most
/// `max_count`: a quarter of the work, and what is left of a blurred image.
[[nodiscard]] Landmarks coarse_landmarks_of(const GreyImage& grey, const DepthImage& depth_m,
                                            const PinholeCamera& camera, int max_count,
                                            const config::PlaceFeaturesConfig& features,
                                            const config::RelocalisationConfig& relocalisation);

/// The depth of a feature; 0 if it is at an edge of depth, where it may be that of the thing behind.
[[nodiscard]] double landmark_depth_m(const DepthImage& depth_m, const Vector2d& pixel_px,
                                      const config::RelocalisationConfig& config);

}  // namespace fusebench::places
