// The same view in another number of pixels.
#pragma once

#include "core/base/types.hpp"

namespace fusebench::calibration {

/// The pinhole camera of an image that shows what `camera` sees in width_px x height_px pixels. The corners
/// of both images coincide: (u + 0.5) is scaled, since pixel (0, 0) has its centre there. camera must have
/// its size.
[[nodiscard]] PinholeCamera scaled_camera(const PinholeCamera& camera, int width_px, int height_px);

}  // namespace fusebench::calibration
