// How the camera turned between two frames, from their intensities alone.
#pragma once

#include "core/systems/elasticfusion/tracking/pyramids.hpp"

namespace fusebench::systems::elasticfusion::tracking {

/// R_before_now of two small images of one camera, as if everything were far away, from no rotation on: at
/// most ten steps, as long as the mean squared difference falls. Gradients are means of those of both images,
/// as in the program (efficient second-order minimisation, Malis 2004): where the texture is as fine as the
/// turn, those of one image end in the nearest wrong minimum. No rotation where the images hardly overlap or
/// have no texture.
[[nodiscard]] Quaterniond rotation_between(const LiveLevel& before, const LiveLevel& now);

}  // namespace fusebench::systems::elasticfusion::tracking
