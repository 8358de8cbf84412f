// Whether two depth images fit together at a motion, each seen from the other's camera
// (Dai et al. 2017, Sec. 4.2: dense two-sided geometric and photometric verification; here by depth alone).
#pragma once

#include "core/systems/bundlefusion/depth_cloud.hpp"

namespace fusebench::systems::bundlefusion {

struct DenseLimits {
  double max_error_m = 0;        ///< of the mean distance of what should coincide
  double min_overlap_share = 0;  ///< of the cells, those that coincide
};

/// True if, in both directions, enough cells find a surface where they fall in the other image, and their
/// mean distance is small. A point in front of the surface that the other camera saw counts with its
/// distance: it would have been seen.
[[nodiscard]] bool fit_together(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b,
                                const DenseLimits& limits);

}  // namespace fusebench::systems::bundlefusion
