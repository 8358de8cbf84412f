// Verifies that two frames show the same place and estimates their relative pose: by features or, without
// features (blur, a bare wall), by depth. Then checks the depth of both against each other.
#pragma once

#include <string>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/appearance.hpp"
#include "core/estimator/places/dense_alignment.hpp"

namespace fusebench::places {

/// Result of the verification of a pair.
struct VerifiedPair {
  bool same = false;
  std::string reason;  ///< reason of the failure; empty if same
  int matches = 0;
  int inliers = 0;
  bool by_depth_alone = false;
  double consistent_share = 0;             ///< of depth, the smaller one of both directions
  double violating_share = 0;              ///< the larger one of both directions
  SE3 T_known_query;                       ///< relative pose of the cameras
  Matrix6d covariance = Matrix6d::Zero();  ///< rotation on the right, position in the frame of `known`
};

/// Matches the landmarks of `query` and `known` (P3P in RANSAC, as for relocalisation) and refines the pose
/// by depth (dense_alignment.hpp). If the result is not certain, runs verify_by_depth() from the relative
/// pose of the path, if the views overlap by it. Finally checks the depth of each against the other: same
/// surface or violated free space.
[[nodiscard]] VerifiedPair verify_pair(const Appearance& known, const Appearance& query,
                                       const SE3& T_known_query_by_path, const PinholeCamera& camera,
                                       const config::Config& config);

/// Verifies a pose from features, with its covariance: refines it and checks it by depth in both directions.
[[nodiscard]] VerifiedPair verify_from_features(const SmallImages& known, const SmallImages& query,
                                                const RelativePose& pose, const PinholeCamera& camera,
                                                const config::Config& config);

/// Verifies by depth alone, aligned from `start`, whose error may be about reach_m (AlignmentStart). Requires
/// that depth constrains all axes, that intensities correlate where both images have contrast, and that the
/// depths agree.
[[nodiscard]] VerifiedPair verify_by_depth(const SmallImages& known, const SmallImages& query,
                                           const SE3& T_known_query_start, double reach_m,
                                           const PinholeCamera& camera, const config::Config& config);

}  // namespace fusebench::places
