// Whether a pose that was found by matching is the place, or something that looks like it.
//
// A false place is worse than none: what is fused there spoils the model. In simulated rooms up to 16 of 40
// matches agree between an image and a keyframe of another room (most often fewer than 6), and wall paper and
// floors that repeat let up to 28 of 84 agree on a pose that is off by a whole repetition; but these lie in
// one part of the image, from where a pose is vague. A scene that repeats as a whole cannot be told by its
// looks: hold the pose against what is known from elsewhere.
#pragma once

#include <cstddef>
#include <span>

#include "core/pose_from_points.hpp"
#include "core/types.hpp"

namespace fusebench {

inline constexpr std::size_t kMinPlaceInliers = 25;  ///< 1.5 times what another room gave at most

/// True if enough points agree, a fair share of all, all over the image, on a pose that they tell well.
[[nodiscard]] bool is_certain_place(std::span<const SeenPoint> seen, const PoseFromPoints& pose,
                                    const PinholeCamera& camera);

}  // namespace fusebench
