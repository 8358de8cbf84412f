// Geometry-aware deformation of patches (Sec. 2.1.1): motion of the pixels of a patch to another view, their
// visibility there, and the change of the patch's shape.
#pragma once

#include <span>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/patches/patch_lanes.hpp"
#include "core/estimator/patches/patches.hpp"

namespace fusebench::patches {

/// Sets warp_point_world and warp_offset_px of all pixels (Eqs. 1-2): by pixel, by one plane, or as a rigid
/// square. With the last two, a patch without a surface at its centre or without a plane loses all pixels.
void set_deformation(Patch& patch, const PinholeCamera& camera, const SE3& T_world_camera,
                     config::Deformation deformation);

/// Projects the pixels of one level of the given patches (Eq. 2). `camera` is of that level. Sets visible =
/// in_image. warp_points: as LevelLanes.
void warp_level(std::span<const PixelLanes> pixels, std::span<const WarpPointLanes> warp_points,
                const PosedLanes& camera, std::span<WarpedLanes> warped);

/// Shrink test over all patches: of the pixels in one cell, those behind the nearest one by more than a limit
/// become invisible (the occluder may belong to another patch). With z the depth of the nearest one, the
/// limit is max(3 sigma(z), edge_jump * z); with ShrinkTest::any_collision it is 0.
class MutualOcclusion {
 public:
  /// Size of the level's image.
  void resize(int width_px, int height_px);

  /// Tests all pixels of the level.
  void test(std::span<WarpedLanes> warped, const config::DepthConfig& depth, config::ShrinkTest rule);

 private:
  int width_px_ = 0;
  std::vector<float> nearest_m_;  ///< by cell; infinite outside of test()
};

/// Visibility test against the measured depth z. A pixel whose depth differs from z by more than
/// max(tolerance_m, 3 sigma(z)) is occluded (covered: z is smaller) or its surface has disappeared. `scale` =
/// 2^level maps pixels to the depth image.
void test_measured_occlusion(std::span<WarpedLanes> warped, const DepthImage& depth_m, int scale,
                             double tolerance_m, const config::DepthConfig& depth);

/// Extend test: compares the bounding box of the visible pixels with the square.
[[nodiscard]] bool is_extended(std::span<const WarpedLanes> warped, int size_px);

}  // namespace fusebench::patches
