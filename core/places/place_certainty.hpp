// Whether a relocalised pose is certain, or perhaps a false match.
//
// A false pose is worse than none: what is fused at it corrupts the model. In simulated rooms up to 16 of 40
// matches agree between an image and a keyframe of another room (most often fewer than 6), and wall paper and
// floors that repeat let up to 28 of 84 agree on a pose that is off by a whole repetition; but these lie in
// one part of the image, which constrains a pose badly. A scene that repeats as a whole is ambiguous by
// appearance: gate the pose by the prediction as well.
#pragma once

#include <span>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/places/pose_from_points.hpp"

namespace fusebench::places {

/// True if there are enough inliers, a sufficient share of all matches, spread over the image, and the pose
/// is well constrained by them.
[[nodiscard]] bool is_certain_place(std::span<const SeenPoint> seen, const PoseFromPoints& pose,
                                    const PinholeCamera& camera, const config::RelocalisationConfig& config);

}  // namespace fusebench::places
