// Selection of patch centres: FAST corners with depth, spread over the image.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::patches {

/// New patch centres (pixels of the image) in addition to the existing ones, best corner first within each
/// cell of a grid that has about max_count cells, then the best of the rest. Each keeps min_distance_px to
/// all others, lies far enough inside the image, and has depth in at least min_valid_fraction of its square.
[[nodiscard]] std::vector<Eigen::Vector2i> select_corners(const GreyImage& grey, const DepthImage& depth_m,
                                                          std::span<const Eigen::Vector2i> existing,
                                                          const config::PatchConfig& config);

/// True if a patch of that centre lies inside the image with room for interpolation.
[[nodiscard]] bool patch_fits(const GreyImage& grey, const Eigen::Vector2i& centre, int size_px);

}  // namespace fusebench::patches
