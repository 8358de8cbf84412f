// Rays against the model: depth and surface normal as a camera at a given pose would see them.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/raycast/surface_point.hpp"
#include "core/tsdf/tsdf_lanes.hpp"

namespace fusebench::raycast {

/// A pixel, and the requested interval of its ray (z-depth, metres; depth.min_m and max_m hold as well).
struct PixelRay {
  double u_px = 0;
  double v_px = 0;
  float begin_m = 0;
  float end_m = std::numeric_limits<float>::infinity();
};

/// The first zero crossings from front to back between depth.min_m and depth.max_m along the rays of pixels,
/// by steps of the field's own size, refined to the crossing of the trilinear field; invalid where a ray
/// meets no observed surface, crosses from behind, or the normal cannot be computed. Single precision: depth
/// is good to a thousandth of a voxel. `field`: in view of the camera (field_in_view). In parallel; results
/// in the order of the pixels, in memory that is used again. Neighbours in the list should be neighbours in
/// the image.
void raycast_pixels(const tsdf::TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                    std::span<const PixelRay> pixels, const config::DepthConfig& depth,
                    const Workers& workers, std::vector<SurfacePoint>& points);

}  // namespace fusebench::raycast
