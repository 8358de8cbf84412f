#include "core/estimator/model/tsdf/tsdf_brick.hpp"

#include <algorithm>
#include <cstddef>

#include "core/estimator/model/tsdf/trilinear.hpp"

namespace fusebench::tsdf {

static_assert(kBlockSide == simd::kLanes, "a row of a block is one vector");

/// Voxels of the brick around eight positions.
struct TsdfBrick::Cube {
  /// `side` voxels along each axis, from `first` on.
  Cube(const TsdfBrick& brick, const LatticePoints& first, int side)
      : distances_m(brick.distances_m_.data()), row(brick.size_.x()), slice(row * brick.size_.y()) {
    const simd::Int8 x = first.x;
    const simd::Int8 y = first.y;
    const simd::Int8 z = first.z;
    inside = ((x | y | z) >= 0) & (x <= brick.size_.x() - side) & (y <= brick.size_.y() - side) &
             (z <= brick.size_.z() - side);
    at = inside ? x + row * y + slice * z : simd::Int8{};
  }

  [[nodiscard]] simd::Pairs pair_m(int x, int y, int z) const {
    return simd::gather_pairs(distances_m + (x + row * y + slice * z), at);
  }

  const simd::Half* distances_m;
  int row, slice;  // strides of rows and slices in voxels
  simd::Int8 inside;
  simd::Int8 at;
};

void TsdfBrick::copy(const TsdfVolume& volume, const VoxelIndex& first, const VoxelIndex& last) {
  const BlockIndex first_block = block_of(first);
  const BlockIndex last_block = block_of(last);
  const VoxelIndex origin(first_block.x() * kBlockSide, first.y(), first.z());
  const Eigen::Vector3i size((last_block.x() + 1) * kBlockSide - origin.x(), last.y() - first.y() + 1,
                             last.z() - first.z() + 1);
  origin_voxel_ = origin;
  size_ = size;
  const auto voxels = static_cast<std::size_t>(size.prod());
  // Padding: lanes outside the brick gather from the first voxel a cube of four voxels, in pairs.
  const std::size_t readable = voxels + static_cast<std::size_t>(4 * size.x() * (size.y() + 1));
  if (distances_m_.size() < readable) distances_m_.resize(readable);
  BlockIndex block;
  for (block.z() = first_block.z(); block.z() <= last_block.z(); ++block.z()) {
    for (block.y() = first_block.y(); block.y() <= last_block.y(); ++block.y()) {
      for (block.x() = first_block.x(); block.x() <= last_block.x(); ++block.x()) {
        // Slot -1, for an unallocated block, is readable and unobserved.
        const std::ptrdiff_t slot = volume.find_block(block);
        copy_block(volume.distances_m() + slot * kBlockVoxels, block * kBlockSide);
      }
    }
  }
}

/// Copies the rows of a block inside the box.
void TsdfBrick::copy_block(const simd::Half* block_m, const VoxelIndex& block_voxel) {
  const Eigen::Vector3i from = block_voxel - origin_voxel_;
  const int begin_y = std::max(0, -from.y());
  const int end_y = std::min(kBlockSide, size_.y() - from.y());
  const int begin_z = std::max(0, -from.z());
  const int end_z = std::min(kBlockSide, size_.z() - from.z());
  for (int z = begin_z; z < end_z; ++z) {
    simd::Half* row =
        distances_m_.data() + from.x() + size_.x() * (from.y() + begin_y + size_.y() * (from.z() + z));
    for (int y = begin_y; y < end_y; ++y, row += size_.x()) {
      std::copy_n(block_m + kBlockSide * (y + kBlockSide * z), kBlockSide, row);
    }
  }
}

simd::Float8 TsdfBrick::sample(const simd::Points& at) const {
  const TrilinearCell cell(at);
  const Cube cube(*this, cell.base, 2);
  const simd::Float8 distance_m = interpolated_m(cell, cube);
  return cube.inside ? distance_m : not_a_number();
}

simd::Points TsdfBrick::gradient(const simd::Points& at) const {
  const TrilinearCell cell(at);
  const Cube cube(*this, {cell.base.x - 1, cell.base.y - 1, cell.base.z - 1}, 4);
  const simd::Points gradient = interpolated_gradient(cell, cube);
  const simd::Float8 unknown = not_a_number();
  return {cube.inside ? gradient.x : unknown, cube.inside ? gradient.y : unknown,
          cube.inside ? gradient.z : unknown};
}

}  // namespace fusebench::tsdf
