// Contiguous copy of the field in a small box, which avoids block lookups for many close points.
#pragma once

#include <vector>

#include "core/base/simd/lane_points.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::tsdf {

/// Distances of a box of voxels. Reuses its memory.
class TsdfBrick {
 public:
  /// Copies the voxels from `first` to `last` on each axis; the box is extended along x to whole blocks.
  void copy(const TsdfVolume& volume, const VoxelIndex& first, const VoxelIndex& last);

  /// Origin of the voxel coordinates.
  [[nodiscard]] const VoxelIndex& origin_voxel() const { return origin_voxel_; }

  /// As TsdfLanes::sample() and gradient(), bit-identical for equal coordinates; NaN also outside the box.
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
