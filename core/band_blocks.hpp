// Which blocks of the lattice a depth image touches.
#pragma once

#include <functional>
#include <vector>

#include "core/block_table.hpp"
#include "core/config.hpp"
#include "core/parallel.hpp"
#include "core/types.hpp"

namespace fusebench {

/// Every block that a ray of a measured pixel passes from truncation_m(depth) in front of the measurement to
/// as far behind it (both along z), once each, in the order of the pixels (row-major), then from front to
/// back. Depth outside [min_m, max_m] of `depth` is skipped. The same for every number of threads.
[[nodiscard]] std::vector<BlockIndex> band_blocks(const DepthImage& depth_m, const PinholeCamera& camera,
                                                  const SE3& T_world_camera, double block_m,
                                                  const DepthConfig& depth,
                                                  const std::function<double(double)>& truncation_m,
                                                  const Workers& workers);

}  // namespace fusebench
