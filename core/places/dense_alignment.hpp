// The relative pose of two frames by their depth alone or together with what features say of it: points of
// one on planes of the other (Chen & Medioni 1992), at a quarter of the images' size, where motion blur and
// missing texture hardly matter.
#pragma once

#include <optional>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/places/small_images.hpp"

namespace fusebench::places {

/// A pose with its covariance: rotation on the right (rad), position in the frame of `known` (metres).
struct RelativePose {
  SE3 T_known_query;
  Matrix6d covariance = Matrix6d::Zero();
};

/// From where a pose is searched.
struct AlignmentStart {
  RelativePose pose;
  bool from_features = false;
  double reach_m = 0;  ///< points so far from their plane count at first; at least LoopsConfig::dense_gate_m
};

/// Searches from that pose. With `from_features`, its covariance counts: directions that depth does not tell,
/// such as sideways along a wall, stay as they were; without, the pose is no more than the start. Nothing if
/// too little of the depth lies near the other surface, or it leaves a direction open. The covariance is that
/// of the scatter, as LoopsConfig::dense_measurements counts it.
[[nodiscard]] std::optional<RelativePose> aligned_by_depth(const SmallImages& known, const SmallImages& query,
                                                           const AlignmentStart& start,
                                                           const PinholeCamera& camera,
                                                           const config::DepthConfig& depth,
                                                           const config::LoopsConfig& loops);

}  // namespace fusebench::places
