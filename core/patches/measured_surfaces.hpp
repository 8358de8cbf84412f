// The measured surface behind pixels of a frame: what a patch is made of if it does not take the model's.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/raycast/surface_point.hpp"
#include "core/raycast/surface_search.hpp"

namespace fusebench::patches {

/// Normals of measured depth are differences over this many pixels either way, since neighbouring pixels of
/// structured-light depth share their disparity step.
inline constexpr int kNormalReach_px = 4;

/// One surface a pixel: its measured depth, and the normal of the depth image around it. Invalid where
/// nothing was measured; the normal is zero where a neighbour that it takes is missing.
[[nodiscard]] std::vector<raycast::SurfacePoint> measured_surfaces(
    const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera,
    std::span<const raycast::ExpectedSurface> pixels);

}  // namespace fusebench::patches
