// Measured surfaces at pixels of a frame, for patches that do not use the model's surface.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/estimator/model/raycast/surface_point.hpp"
#include "core/estimator/model/raycast/surface_search.hpp"

namespace fusebench::patches {

/// Normals are differences of depth over this many pixels to either side, since neighbouring pixels of
/// structured-light depth share a disparity step.
inline constexpr int kNormalReach_px = 4;

/// One surface for each pixel: its measured depth and the normal of the depth image. Invalid without a
/// measurement. The normal is zero if a required neighbour is missing.
[[nodiscard]] std::vector<raycast::SurfacePoint> measured_surfaces(
    const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera,
    std::span<const raycast::ExpectedSurface> pixels);

}  // namespace fusebench::patches
