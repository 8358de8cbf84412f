// Tracks a patch by its own translation in the image (Lucas & Kanade 1981, coarse to fine as in Bouguet
// 2000), independently of the common pose.
#pragma once

#include <span>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/estimator/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// A patch at one pyramid level, at its predicted position.
struct PlacedPatch {
  std::span<const patches::PixelLanes> pixels;
  std::span<const patches::WarpedLanes> warped;
  const GreyImage& image;
};

/// The translation (pixels of level 0) with the least sum of squared grey differences. Gauss-Newton steps
/// from zero, on each level from the coarsest (the last) on. Zero for a patch without visible pixels. The
/// steps end if the patch lacks texture in some direction.
[[nodiscard]] Vector2d own_translation_px(std::span<const PlacedPatch> levels);

/// Moves the pixels of a level; pixels that leave the image become invisible.
void translate(std::span<patches::WarpedLanes> warped, const Vector2d& by_px, const GreyImage& image);

}  // namespace fusebench::measurement
