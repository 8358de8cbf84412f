// Keypoints that were matched through a chunk, each once (Dai et al. 2017, Sec. 4.3: per-chunk keyframes).
#pragma once

#include <span>

#include "core/systems/bundlefusion/pose_adjustment.hpp"

namespace fusebench::systems::bundlefusion {

/// Keypoints of the frames that are connected by matches, as keypoints of the first camera: the mean of their
/// points, and the descriptor of the earliest. In the order of those. Tracks behind the first camera are left
/// out.
[[nodiscard]] Keypoints merge_tracks(std::span<const Keypoints* const> keypoints,
                                     std::span<const FramePair> pairs, const Poses& T_first_camera,
                                     const PinholeCamera& camera);

}  // namespace fusebench::systems::bundlefusion
