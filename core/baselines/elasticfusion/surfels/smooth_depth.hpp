// Edge-preserving smoothing of depth, for tracking and normals.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"

namespace fusebench::baselines::elasticfusion::surfels {

/// Bilateral mean of the measured pixels within 6 px of each measured pixel (Gaussians of 4.5 px and 30 mm);
/// 0 without a measurement.
[[nodiscard]] DepthImage smooth_depth(const DepthImage& depth_m, const Workers& workers);

}  // namespace fusebench::baselines::elasticfusion::surfels
