// Ray casting into the model: depth and surface normal for a camera pose.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/raycast/surface_point.hpp"
#include "core/estimator/model/tsdf/tsdf_lanes.hpp"

namespace fusebench::raycast {

/// A pixel and the requested interval of its ray (z-depth, metres; depth.min_m and max_m also apply).
struct PixelRay {
  double u_px = 0;
  double v_px = 0;
  float begin_m = 0;
  float end_m = std::numeric_limits<float>::infinity();
};

/// First zero crossings from front to back along the rays of pixels, between depth.min_m and depth.max_m. The
/// step is the value of the field; the crossing is refined in the trilinear field. Invalid if a ray meets no
/// observed surface, crosses from behind, or has no valid normal. Single precision: the depth is accurate to
/// a thousandth of a voxel. `field`: in view of the camera (field_in_view). Parallel; results are in the
/// order of the pixels, in reused memory. Neighbours in the list should be neighbours in the image.
void raycast_pixels(const tsdf::TsdfLanes& field, const PinholeCamera& camera, const SE3& T_world_camera,
                    std::span<const PixelRay> pixels, const config::DepthConfig& depth,
                    const Workers& workers, std::vector<SurfacePoint>& points);

}  // namespace fusebench::raycast
