// The blocks around the measurements of a depth image, felt for along the rays in small steps.
#pragma once

#include <array>
#include <cstddef>
#include <set>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/estimator/model/tsdf/band_blocks.hpp"

namespace fusebench::testing {

using BlockSet = std::set<std::array<int, 3>>;

inline BlockSet block_set(const std::vector<tsdf::BlockIndex>& indices) {
  BlockSet blocks;
  for (const tsdf::BlockIndex& block : indices) blocks.insert({block.x(), block.y(), block.z()});
  return blocks;
}

/// Of every pixel of every row, or of every `every_px`-th one.
inline BlockSet felt_blocks(const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera,
                            double block_m, const config::TsdfConfig& tsdf, const config::DepthConfig& depth,
                            int every_px = 1) {
  BlockSet blocks;
  for (int y = 0; y < depth_m.height; y += every_px) {
    for (int x = 0; x < depth_m.width; x += every_px) {
      const double z = static_cast<double>(depth_m(x, y));
      if (!(z >= depth.min_m && z <= depth.max_m)) continue;
      const double band_m = tsdf::half_band_m(z, tsdf, depth);
      for (int step = 0; step <= 40; ++step) {
        const double at_m = z + band_m * (step / 20.0 - 1.0);
        const Vector3d point = T_world_camera * camera.back_project(x, y, at_m) / block_m;
        const tsdf::BlockIndex block = point.array().floor().cast<int>();
        blocks.insert({block.x(), block.y(), block.z()});
      }
    }
  }
  return blocks;
}

/// How many of the wanted ones were not found.
inline std::size_t missing(const BlockSet& wanted, const BlockSet& found) {
  std::size_t count = 0;
  for (const auto& block : wanted) count += found.contains(block) ? 0U : 1U;
  return count;
}

}  // namespace fusebench::testing
