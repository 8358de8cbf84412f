// Tests whether two depth images are consistent at a relative pose, in both directions (Dai et al. 2017, Sec.
// 4.2: dense two-sided geometric and photometric verification; here by depth alone).
#pragma once

#include "core/baselines/bundlefusion/depth_cloud.hpp"

namespace fusebench::baselines::bundlefusion {

struct DenseLimits {
  double max_error_m = 0;        ///< limit of the mean distance of corresponding points
  double min_overlap_share = 0;  ///< least share of corresponding cells
};

/// True if in both directions enough cells have a corresponding surface in the other image, with a small mean
/// distance. A point in front of the other surface counts with its distance, since it would have been
/// visible.
[[nodiscard]] bool fit_together(const DepthCloud& a, const DepthCloud& b, const SE3& T_a_b,
                                const DenseLimits& limits);

}  // namespace fusebench::baselines::bundlefusion
