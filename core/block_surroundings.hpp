// The field in and around one block, side by side.
#pragma once

#include <array>
#include <cstddef>

#include "core/tsdf_volume.hpp"

namespace fusebench {

/// Distances of a block's voxels and of those around it, copied once so that neighbours need no lookup.
class BlockSurroundings {
 public:
  /// Copies from one voxel before the block to two behind it on each axis.
  void load(const TsdfVolume& volume, const BlockIndex& index);

  /// Gradient of the field (metres of distance per voxel) at a voxel by its place in the block, from 0 to
  /// kBlockSide on each axis: central differences, one-sided next to unobserved voxels, 0 along an axis where
  /// both neighbours are unobserved. The voxel itself must be observed.
  [[nodiscard]] Vector3d gradient(const VoxelIndex& local) const;

 private:
  static constexpr int kBefore = 1;
  static constexpr int kSide = kBefore + kBlockSide + 2;

  static std::size_t place(const VoxelIndex& local) {
    const auto at = (local.array() + kBefore).cast<std::size_t>();
    return at.x() + kSide * (at.y() + kSide * at.z());
  }
  void load_neighbour(const TsdfVolume& volume, const BlockIndex& index, const BlockIndex& offset);

  std::array<float, static_cast<std::size_t>(kSide* kSide* kSide)> distances_m_{};
};

}  // namespace fusebench
