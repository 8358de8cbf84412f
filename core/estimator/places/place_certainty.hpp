// Decides whether a relocalised pose is certain or may be a false match.
//
// A false pose is worse than no pose, since frames fused at it corrupt the model. In simulated rooms up to 16
// of 40 matches agree between an image and a keyframe of another room (mostly fewer than 6). Repeating
// wallpaper and floors let up to 28 of 84 matches agree on a pose that is off by one repetition. These
// inliers are in one part of the image, which constrains the pose weakly. A scene that repeats as a whole is
// ambiguous by appearance: the pose must also be gated by the prediction.
#pragma once

#include <span>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/places/pose_from_points.hpp"

namespace fusebench::places {

/// True if there are enough inliers with a sufficient share of all matches, they are distributed over the
/// image, and they constrain the pose well.
[[nodiscard]] bool is_certain_place(std::span<const SeenPoint> seen, const PoseFromPoints& pose,
                                    const PinholeCamera& camera, const config::RelocalisationConfig& config);

}  // namespace fusebench::places
