// The whole squares of tracked patches, with the pixels that the estimator does not use: input of definitions
// of the intensity error that know no mask (docs/metrics.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/intensity_residual.hpp"
#include "core/base/types.hpp"
#include "core/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// A tracked patch at level 0, in the current frame.
struct SeenPatch {
  std::uint32_t number = 0;
  bool accepted = false;
  const patches::Patch& patch;
  std::span<const patches::WarpedLanes> warped;
};

/// Adds the pixels of its square: the visible ones where they were warped to, the others moved by the mean
/// motion of these. Pixels that are moved out of the image are left out. reference_width_px: of the frame
/// that the patch was cut from.
void add_square(const SeenPatch& seen, const GreyImage& image, int reference_width_px,
                std::vector<SquarePixel>& pixels);

}  // namespace fusebench::measurement
