// Matching of the keypoints of two frames.
#pragma once

#include <cstddef>
#include <vector>

#include "core/baselines/bundlefusion/keypoints.hpp"

namespace fusebench::baselines::bundlefusion {

/// Indices of two matching keypoints.
struct KeypointMatch {
  std::size_t a = 0;
  std::size_t b = 0;
  double distance = 0;  ///< of the unit-length descriptors: 0 to sqrt(2)
};

/// Mutual nearest neighbours of a and b with a distance below 0.7 and below 0.8 of the second nearest (Lowe
/// 2004). The best 128, nearest first (Dai et al. 2017).
[[nodiscard]] std::vector<KeypointMatch> match_keypoints(const Keypoints& a, const Keypoints& b);

}  // namespace fusebench::baselines::bundlefusion
