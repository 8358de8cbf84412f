// Keypoints of two frames that look alike.
#pragma once

#include <cstddef>
#include <vector>

#include "core/systems/bundlefusion/keypoints.hpp"

namespace fusebench::systems::bundlefusion {

/// Indices of two keypoints, one of each frame.
struct KeypointMatch {
  std::size_t a = 0;
  std::size_t b = 0;
  double distance = 0;  ///< of the descriptors, scaled to unit length: 0 to sqrt(2)
};

/// Every keypoint of a against every one of b: those that are each other's nearest, nearer than 0.7, and
/// nearer than 0.8 of the second nearest (Lowe 2004). The best 128, the nearest first (Dai et al. 2017).
[[nodiscard]] std::vector<KeypointMatch> match_keypoints(const Keypoints& a, const Keypoints& b);

}  // namespace fusebench::systems::bundlefusion
