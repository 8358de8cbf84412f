// Places within the pixel at which the instants of an exposure are sampled.
#pragma once

#include <vector>

#include "core/base/types.hpp"

namespace fusebench::simulator::sensors {

/// Offsets from the middle of the pixel, for samples at equal steps of time: a low-discrepancy sequence
/// (Roberts' R2), from which mean and trend over time are taken out, since they would shift the image and
/// change the length of its blur.
[[nodiscard]] std::vector<Vector2d> sample_offsets_px(int samples);

/// For an image that moves by so many pixels during the exposure: a sample for each two pixels, 8 to 64.
/// Fewer than 8 alias, which raises the intensity error of tracked patches.
[[nodiscard]] int samples_of_motion(double motion_px);

}  // namespace fusebench::simulator::sensors
