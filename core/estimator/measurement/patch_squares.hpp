// Whole squares of tracked patches, including pixels that the estimator does not use. Input of the
// definitions of the intensity error without a mask (docs/metrics.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/intensity_residual.hpp"
#include "core/base/types.hpp"
#include "core/estimator/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// A tracked patch at level 0, in the current frame.
struct SeenPatch {
  std::uint32_t number = 0;
  bool accepted = false;
  const patches::Patch& patch;
  std::span<const patches::WarpedLanes> warped;
};

/// Adds the pixels of the square: visible ones at their warped positions, the others moved by the mean motion
/// of the visible ones. Pixels outside the image are skipped. reference_width_px: width of the frame from
/// which the patch was cut.
void add_square(const SeenPatch& seen, const GreyImage& image, int reference_width_px,
                std::vector<SquarePixel>& pixels);

}  // namespace fusebench::measurement
