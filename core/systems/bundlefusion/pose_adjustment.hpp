// Poses of frames by all their matches at once, sparse and dense (Dai et al. 2017, Sec. 4.3).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/systems/bundlefusion/frame_pair.hpp"

namespace fusebench::systems::bundlefusion {

/// Poses of frames by their indices, camera to world; those that have none take no part.
using Poses = std::vector<std::optional<SE3>>;

struct AdjustmentWeights {
  double sparse = 1;       ///< of squared distances of matched points
  double dense = 0;        ///< of squared distances of points from planes; 0: depth is not compared
  double dense_far_m = 0;  ///< where these weigh nothing (plane_sums)
};

/// The matches and depth images that poses are adjusted by; clouds[k] is of frame k, and used if dense is
/// not 0.
struct AdjustmentTerms {
  std::span<const FramePair> pairs;
  std::span<const DepthCloud* const> clouds;
  AdjustmentWeights weights;
};

/// Gauss-Newton steps from the given poses, the first of which stays; each step solves its equations exactly.
/// All frames that have a pose must hang together by their pairs. Depth is compared for all frames whose
/// cameras are turned by less than 30 degrees against each other and of whose cells a sixth coincides. False
/// if the equations are singular; the poses are then those before.
[[nodiscard]] bool adjust_poses(Poses& T_world_camera, const AdjustmentTerms& terms, int steps,
                                const Workers& workers);

}  // namespace fusebench::systems::bundlefusion
