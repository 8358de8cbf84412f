// Sub-pixel positions of the samples of an exposure.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

/// Offsets from the pixel centre for samples at equal time steps: a low-discrepancy sequence (Roberts' R2)
/// without its mean and its trend over time, which would shift the image and change the length of its blur.
[[nodiscard]] std::vector<Vector2d> sample_offsets_px(int samples);

/// Number of samples for an image motion during the exposure: one for each two pixels, 8 to 64. Fewer than 8
/// cause aliasing, which increases the intensity error of tracked patches.
[[nodiscard]] int samples_of_motion(double motion_px);

}  // namespace fusebench::simulator::sensors
