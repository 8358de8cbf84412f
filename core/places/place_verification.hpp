// Whether two frames show the same place, and from where: by features or, where blur or a bare wall leaves
// none, by depth; and by the depth of both against each other.
#pragma once

#include <string>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/places/appearance.hpp"
#include "core/places/dense_alignment.hpp"

namespace fusebench::places {

/// What was found of a pair of frames.
struct VerifiedPair {
  bool same = false;
  std::string reason;  ///< why not; empty if it is
  int matches = 0;
  int inliers = 0;
  bool by_depth_alone = false;
  double consistent_share = 0;             ///< of depth, the smaller one of both directions
  double violating_share = 0;              ///< the larger one
  SE3 T_known_query;                       ///< of the cameras
  Matrix6d covariance = Matrix6d::Zero();  ///< rotation on the right, position in the frame of `known`
};

/// The landmarks of `query` against those of `known` (P3P in RANSAC, as for relocalisation), refined by depth
/// (dense_alignment.hpp). If that is not certain: verify_by_depth() from where the path leads, if both see
/// the same by it. At last the depth of either against that of the other: what the other one sees there, or
/// free space where there should be a surface.
[[nodiscard]] VerifiedPair verify_pair(const Appearance& known, const Appearance& query,
                                       const SE3& T_known_query_by_path, const PinholeCamera& camera,
                                       const config::Config& config);

/// A pose that features found, with its covariance, refined and judged by depth in both directions.
[[nodiscard]] VerifiedPair verify_from_features(const SmallImages& known, const SmallImages& query,
                                                const RelativePose& pose, const PinholeCamera& camera,
                                                const config::Config& config);

/// Depth alone, aligned from that pose, which may be off by about reach_m (AlignmentStart). It has to tell
/// the pose along every axis, intensities have to fit where both images have contrast, and the depth of
/// either that of the other.
[[nodiscard]] VerifiedPair verify_by_depth(const SmallImages& known, const SmallImages& query,
                                           const SE3& T_known_query_start, double reach_m,
                                           const PinholeCamera& camera, const config::Config& config);

}  // namespace fusebench::places
