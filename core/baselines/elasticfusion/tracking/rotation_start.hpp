// Estimates the rotation of the camera between two frames from their intensities.
#pragma once

#include "core/baselines/elasticfusion/tracking/pyramids.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

/// R_before_now of two small images of one camera, for points at infinity. Starts at no rotation; at most ten
/// steps, while the mean squared difference decreases. The gradient is the mean of both images, as in the
/// published program (efficient second-order minimisation, Malis 2004): with texture as fine as the rotation,
/// the gradient of one image alone converges to the nearest local minimum. No rotation if the images hardly
/// overlap or have no texture.
[[nodiscard]] Quaterniond rotation_between(const LiveLevel& before, const LiveLevel& now);

}  // namespace fusebench::baselines::elasticfusion::tracking
