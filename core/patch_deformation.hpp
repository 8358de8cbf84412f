// Geometry-aware deformation of patches (Sec. 2.1.1): how the pixels of a patch move to another view, which
// of them are still visible there, and what became of the patch's shape.
#pragma once

#include <span>
#include <vector>

#include "core/config.hpp"
#include "core/patches.hpp"
#include "core/residuals.hpp"

namespace fusebench {

/// Sets warp_point_world and warp_offset_px of all pixels (Eqs. 1-2): pixelwise, by one plane, or as a rigid
/// square. For the last two, a patch without a surface at its centre or without a plane loses all its pixels.
void set_deformation(Patch& patch, const PinholeCamera& camera, const SE3& T_world_camera,
                     Deformation deformation);

/// A patch pixel in the current frame (Eq. 2), in pixels of the patch level.
struct WarpedPixel {
  Vector2d pixel_px = Vector2d::Zero();
  Vector3d warp_point_camera = Vector3d::Zero();  ///< what was projected (for the Jacobian)
  double depth_m = 0;                             ///< z of the pixel's own surface point
  bool in_image = false;  ///< in front of the camera and inside, with room to interpolate
  bool visible = false;   ///< in_image and not occluded
  bool covered = false;   ///< in_image, and something nearer was measured there
};

/// Projects the pixels of one level. `posed` has the camera of that level. visible = in_image until a test
/// says otherwise.
[[nodiscard]] std::vector<WarpedPixel> warp_level(const PatchLevel& level, const PosedCamera& posed);

/// Shrink test, over all patches at once: of the pixels that land in one cell, those clearly behind the
/// nearest become invisible (an occluder may belong to another patch). `warped[i]` are the pixels of patch i
/// at one level.
void test_mutual_occlusion(std::span<std::vector<WarpedPixel>> warped, int width_px, int height_px,
                           const DepthConfig& depth);

/// Against what the camera measured: a pixel whose depth differs from the measurement by more than
/// tolerance_m is occluded or belongs to a surface that appeared. `scale` = 2^level maps pixels to the depth
/// image.
void test_measured_occlusion(std::span<WarpedPixel> warped, const DepthImage& depth_m, int scale,
                             double tolerance_m, const DepthConfig& depth);

/// Bounding box of the visible pixels against the square (extend test).
[[nodiscard]] bool is_extended(std::span<const WarpedPixel> warped, int size_px);

}  // namespace fusebench
