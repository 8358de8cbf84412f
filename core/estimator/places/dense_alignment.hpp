// Relative pose of two frames by depth, optionally combined with a pose from features: point-to-plane
// alignment (Chen & Medioni 1992) at a quarter of the image size, where motion blur and missing texture have
// little effect.
#pragma once

#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/small_images.hpp"

namespace fusebench::places {

/// A pose with its covariance: rotation on the right (rad), position in the frame of `known` (metres).
struct RelativePose {
  SE3 T_known_query;
  Matrix6d covariance = Matrix6d::Zero();
};

/// Start of the search.
struct AlignmentStart {
  RelativePose pose;
  bool from_features = false;
  /// largest initial distance of a point to its plane; at least LoopsConfig::dense_gate_m
  double reach_m = 0;
};

/// Aligns from the start pose. With `from_features`, the covariance of the start is a prior: directions that
/// depth does not constrain, such as sideways along a wall, keep their values. Nothing if too little depth is
/// near the other surface or a direction is not constrained. The covariance is that of the scatter, as
/// weighted by LoopsConfig::dense_measurements.
[[nodiscard]] std::optional<RelativePose> aligned_by_depth(const SmallImages& known, const SmallImages& query,
                                                           const AlignmentStart& start,
                                                           const PinholeCamera& camera,
                                                           const config::DepthConfig& depth,
                                                           const config::LoopsConfig& loops);

}  // namespace fusebench::places
