// Which blocks of the lattice a depth image touches.
#pragma once

#include <algorithm>
#include <vector>

#include "core/block_table.hpp"
#include "core/config.hpp"
#include "core/depth_gates.hpp"
#include "core/parallel.hpp"
#include "core/types.hpp"

namespace fusebench {

/// Half width of the band (metres) around a measurement: tsdf.truncation_m, two voxels, or
/// tsdf.truncation_sigmas of the depth noise, whichever is most.
[[nodiscard]] inline double half_band_m(double depth_m, const TsdfConfig& tsdf, const DepthConfig& depth) {
  return std::max(std::max(tsdf.truncation_m, 2.0 * tsdf.voxel_m),
                  tsdf.truncation_sigmas * depth_sigma_m(depth_m, depth));
}

/// Every block that a ray of a measured pixel passes from half a band in front of the measurement to as far
/// behind it (both along z), once each, in the order of the pixels (row-major), then from front to back.
/// Depth outside [min_m, max_m] of `depth` is skipped. The same for every number of threads.
[[nodiscard]] std::vector<BlockIndex> band_blocks(const DepthImage& depth_m, const PinholeCamera& camera,
                                                  const SE3& T_world_camera, double block_m,
                                                  const TsdfConfig& tsdf, const DepthConfig& depth,
                                                  const Workers& workers);

}  // namespace fusebench
