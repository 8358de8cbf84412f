// Point to plane: pixels of a frame against what a camera sees of the model.
#pragma once

#include "core/base/parallel.hpp"
#include "core/systems/elasticfusion/tracking/pyramids.hpp"
#include "core/systems/pose_sums.hpp"

namespace fusebench::systems::elasticfusion::tracking {

/// Sums over the pixels of a level that have a match: each is moved into the view's camera, and compared with
/// the point at the nearest pixel along the normal there. Matches are within 10 cm, and their normals within
/// 20 degrees. Steps move points in the frame of the view's camera (rotation, then translation).
[[nodiscard]] PoseSums match_planes(const LiveLevel& live, const ViewLevel& view, const SE3& T_view_camera,
                                    const Workers& workers);

}  // namespace fusebench::systems::elasticfusion::tracking
