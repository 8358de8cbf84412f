// Which points of a true surface a recording can have seen.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/image.hpp"
#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "eval/metrics/mesh_error/triangle_tree.hpp"

namespace fusebench::mesh_error {

/// What makes a point of the ground truth an observed one, in some view that has it inside its image and its
/// range of depth.
enum class Culling {
  frustum,    ///< nothing more (iMAP, NICE-SLAM)
  occlusion,  ///< nothing of the ground truth lies between it and the camera, but for the last centimetre
  depth,      ///< the view's depth image measured there, and the point is no more than 3 cm or 2 % behind
};
[[nodiscard]] std::string_view to_string(Culling culling);  ///< "frustum", "occlusion", "depth"

/// From where the ground truth was seen.
struct MeshViews {
  PinholeCamera camera;
  double min_depth_m = 0;
  double max_depth_m = std::numeric_limits<double>::infinity();
  std::vector<SE3> T_truth_camera;
  Culling culling = Culling::occlusion;
  std::vector<DepthImage> depth_m = {};  ///< one a view with Culling::depth
};

/// The numbers of the points that are observed, in order.
[[nodiscard]] std::vector<std::size_t> observed_points(std::span<const Vector3d> points_truth,
                                                       const TriangleTree& truth, const MeshViews& views,
                                                       const Workers& workers);

}  // namespace fusebench::mesh_error
