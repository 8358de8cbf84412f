// Pairs of frames with matches that passed all filters (Dai et al. 2017, Sec. 4.2).
#pragma once

#include <cstddef>
#include <optional>

#include "core/baselines/bundlefusion/depth_cloud.hpp"
#include "core/baselines/bundlefusion/pair_filters.hpp"

namespace fusebench::baselines::bundlefusion {

/// Data for matching a frame, or a chunk of frames in the camera of its first one.
struct View {
  Keypoints keypoints;
  DepthCloud cloud;
};

/// Indices of two frames and their matches.
struct FramePair {
  std::size_t a = 0;
  std::size_t b = 0;
  RigidMatches rigid;
};

/// Matches two views; nothing unless they pass the filters by motion, area and depth.
[[nodiscard]] std::optional<RigidMatches> match_views(const View& a, const View& b);

}  // namespace fusebench::baselines::bundlefusion
