// A patch is found by a translation of its own in the image, as trackers of features do (Lucas & Kanade 1981,
// coarse to fine as Bouguet 2000), not by the pose that all patches agree on.
#pragma once

#include <span>

#include "core/base/image.hpp"
#include "core/base/types.hpp"
#include "core/patches/patch_lanes.hpp"

namespace fusebench::measurement {

/// A patch at one pyramid level, where a prediction puts it.
struct PlacedPatch {
  std::span<const patches::PixelLanes> pixels;
  std::span<const patches::WarpedLanes> warped;
  const GreyImage& image;
};

/// The translation, pixels of level 0, that makes the sum of squared differences of grey levels least: from
/// no translation, by Gauss-Newton steps on each level from the coarsest (the last) on. Zero of a patch
/// without visible pixels; the steps end where the patch has no texture in some direction.
[[nodiscard]] Vector2d own_translation_px(std::span<const PlacedPatch> levels);

/// Moves the pixels of a level; those that leave the image are no longer visible.
void translate(std::span<patches::WarpedLanes> warped, const Vector2d& by_px, const GreyImage& image);

}  // namespace fusebench::measurement
