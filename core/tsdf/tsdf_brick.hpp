// The field of a small box, copied side by side: where many points lie close together, no block has to be
// looked for at each.
#pragma once

#include <vector>

#include "core/simd/lane_points.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::tsdf {

/// Distances of a box of voxels. Its memory serves one box after the other.
class TsdfBrick {
 public:
  /// Copies the voxels from `first` to `last` on each axis; the box is widened along x to whole blocks.
  void copy(const TsdfVolume& volume, const VoxelIndex& first, const VoxelIndex& last);

  /// The voxel that coordinates count from.
  [[nodiscard]] const VoxelIndex& origin_voxel() const { return origin_voxel_; }

  /// As TsdfLanes::sample() and gradient(), the same to the bit for the same coordinates; NaN also where the
  /// box does not reach.
  [[nodiscard]] simd::Float8 sample(const simd::Points& at) const;
  [[nodiscard]] simd::Points gradient(const simd::Points& at) const;

 private:
  struct Cube;

  void copy_block(const simd::Half* block_m, const VoxelIndex& block_voxel);

  VoxelIndex origin_voxel_ = VoxelIndex::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<simd::Half> distances_m_;  // x fastest, then y, then z
};

}  // namespace fusebench::tsdf
