// Point-to-plane registration of a frame with a view of the model.
#pragma once

#include "core/base/parallel.hpp"
#include "core/baselines/elasticfusion/tracking/pyramids.hpp"
#include "core/baselines/pose_sums.hpp"

namespace fusebench::baselines::elasticfusion::tracking {

/// Sums over the pixels of a level with a match. Each is transformed into the view's camera and compared with
/// the point at the nearest pixel along the normal there. Limits of a match: 10 cm, 20 degrees between the
/// normals. The step moves points in the view's camera frame (rotation, then translation).
[[nodiscard]] PoseSums match_planes(const LiveLevel& live, const ViewLevel& view, const SE3& T_view_camera,
                                    const Workers& workers);

}  // namespace fusebench::baselines::elasticfusion::tracking
