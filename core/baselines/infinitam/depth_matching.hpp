// Point-to-plane registration of a depth image with a rendered view of the model.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/infinitam/model_view.hpp"
#include "core/baselines/pose_sums.hpp"

namespace fusebench::baselines::infinitam {

/// Limits and weights of matches.
struct DepthMatching {
  double max_squared_distance_m2 = 0;  ///< limit of a match
  /// Width of Huber's norm (metres); 0: least squares with equal weights (the icp tracker).
  double huber_m = 0;
  double near_m = 0;  ///< with Huber's norm: weight 1 here,
  double far_m = 0;   ///< decreasing quadratically to 0 here
  bool by_weight = false;
  double weight_to_skip = 0;   ///< surfaces of smaller weight are not used
  double weight_to_count = 1;  ///< above weight_to_skip, the weight is proportional and 1 at this value
};

/// Sums over all pixels of a level with a match. Each is transformed to the world, projected into the view's
/// camera, and compared with the point interpolated there (requires four valid pixels) along the interpolated
/// normal. The gradient is that of the norm. Normals are not compared, as in the published program.
[[nodiscard]] PoseSums match_depth(const DepthImage& depth_m, const PinholeCamera& camera,
                                   const SE3& T_world_camera, const ModelView& view,
                                   const DepthMatching& matching, const Workers& workers);

}  // namespace fusebench::baselines::infinitam
