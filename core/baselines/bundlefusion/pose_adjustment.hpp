// Joint optimisation of poses by sparse and dense matches (Dai et al. 2017, Sec. 4.3).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/baselines/bundlefusion/frame_pair.hpp"

namespace fusebench::baselines::bundlefusion {

/// T_world_camera by frame index; frames without a pose are ignored.
using Poses = std::vector<std::optional<SE3>>;

struct AdjustmentWeights {
  double sparse = 1;       ///< weight of squared distances of matched points
  double dense = 0;        ///< weight of squared point-to-plane distances; 0: depth is not used
  double dense_far_m = 0;  ///< distance of zero weight (plane_sums)
};

/// Matches and depth images for the optimisation; clouds[k] belongs to frame k and is used if dense is not 0.
struct AdjustmentTerms {
  std::span<const FramePair> pairs;
  std::span<const DepthCloud* const> clouds;
  AdjustmentWeights weights;
};

/// Gauss-Newton steps from the given poses, with the first pose fixed and an exact solution of the equations
/// in each step. All frames with a pose must be connected by pairs. Depth is compared for pairs of frames
/// that are rotated by less than 30 degrees and of whose cells a sixth corresponds. False if the equations
/// are singular; the poses are then unchanged.
[[nodiscard]] bool adjust_poses(Poses& T_world_camera, const AdjustmentTerms& terms, int steps,
                                const Workers& workers);

}  // namespace fusebench::baselines::bundlefusion
