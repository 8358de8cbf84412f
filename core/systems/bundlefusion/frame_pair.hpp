// Two frames that show the same: matches that have passed all filters (Dai et al. 2017, Sec. 4.2).
#pragma once

#include <cstddef>
#include <optional>

#include "core/systems/bundlefusion/depth_cloud.hpp"
#include "core/systems/bundlefusion/pair_filters.hpp"

namespace fusebench::systems::bundlefusion {

/// What a frame, or a chunk of frames in the camera of its first one, is matched by.
struct View {
  Keypoints keypoints;
  DepthCloud cloud;
};

/// Frames by their indices, and their matches.
struct FramePair {
  std::size_t a = 0;
  std::size_t b = 0;
  RigidMatches rigid;
};

/// The pair if it passes the filters: by motion, by area, and by depth.
[[nodiscard]] std::optional<RigidMatches> match_views(const View& a, const View& b);

}  // namespace fusebench::systems::bundlefusion
