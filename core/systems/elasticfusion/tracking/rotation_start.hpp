// How the camera turned between two frames, from their intensities alone.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::systems::elasticfusion::tracking {

/// R_before_now of two small images of one camera, as if everything were far away: Gauss-Newton from no
/// rotation, at most ten steps, as long as the mean squared difference falls. No rotation where the images
/// hardly overlap or have no texture.
[[nodiscard]] Quaterniond rotation_between(const GreyImage& before, const GreyImage& now,
                                           const PinholeCamera& camera);

}  // namespace fusebench::systems::elasticfusion::tracking
