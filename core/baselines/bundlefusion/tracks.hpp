// Merges the matched keypoints of a chunk to tracks (Dai et al. 2017, Sec. 4.3: per-chunk keyframes).
#pragma once

#include <span>

#include "core/baselines/bundlefusion/pose_adjustment.hpp"

namespace fusebench::baselines::bundlefusion {

/// Tracks of connected frames as keypoints of the first camera, ordered by their earliest keypoints: mean of
/// the points, descriptor of the earliest. Skips tracks behind the first camera.
[[nodiscard]] Keypoints merge_tracks(std::span<const Keypoints* const> keypoints,
                                     std::span<const FramePair> pairs, const Poses& T_first_camera,
                                     const PinholeCamera& camera);

}  // namespace fusebench::baselines::bundlefusion
