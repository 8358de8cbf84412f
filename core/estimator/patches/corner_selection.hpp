// Selection of patch centres: FAST corners with depth, distributed over the image.
#pragma once

#include <span>
#include <vector>

#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"

namespace fusebench::patches {

/// New patch centres (pixels) in addition to the existing ones: the best corner of each cell of a grid with
/// about max_count cells, then the best remaining corners. Each is at least min_distance_px from all others,
/// far enough inside the image, and has depth in at least min_valid_fraction of its square.
[[nodiscard]] std::vector<Eigen::Vector2i> select_corners(const GreyImage& grey, const DepthImage& depth_m,
                                                          std::span<const Eigen::Vector2i> existing,
                                                          const config::PatchConfig& config);

/// True if the square of a patch is inside the image with the margin of the interpolation.
[[nodiscard]] bool patch_fits(const GreyImage& grey, const Eigen::Vector2i& centre, int size_px);

}  // namespace fusebench::patches
