// Point to plane: pixels of a depth image against the rendered view of the model.
#pragma once

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/systems/infinitam/model_view.hpp"
#include "core/systems/pose_sums.hpp"

namespace fusebench::systems::infinitam {

/// How matches are chosen and weighed.
struct DepthMatching {
  double max_squared_distance_m2 = 0;  ///< of a match
  /// Width of Huber's norm (metres); 0: squares, all of one weight (the icp tracker).
  double huber_m = 0;
  double near_m = 0;  ///< with Huber's norm, weights fall from 1 here
  double far_m = 0;   ///< to 0 here, as the square of what is left
  bool by_weight = false;
  double weight_to_skip = 0;   ///< surfaces of less are not used
  double weight_to_count = 1;  ///< beyond that, a match counts in proportion: 1 at so much
};

/// Sums over all pixels of a level that have a match: each is moved into the world, seen from the view's
/// camera, and compared with the point interpolated there (only between four pixels that have one), along the
/// normal interpolated there. The gradient is that of the norm; no test of normals, as in the program.
[[nodiscard]] PoseSums match_depth(const DepthImage& depth_m, const PinholeCamera& camera,
                                   const SE3& T_world_camera, const ModelView& view,
                                   const DepthMatching& matching, const Workers& workers);

}  // namespace fusebench::systems::infinitam
