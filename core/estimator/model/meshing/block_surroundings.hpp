// Contiguous copy of the field in and around one block.
#pragma once

#include <array>
#include <cstddef>

#include "core/estimator/model/tsdf/block_slots.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::meshing {

/// Distances of the voxels of a block and its surroundings, copied once to avoid lookups of neighbours.
class BlockSurroundings {
 public:
  explicit BlockSurroundings(const tsdf::TsdfVolume& volume) : volume_(volume), slots_(volume) {}

  /// Copies from one voxel before to two voxels after the block, on each axis.
  void load(const tsdf::BlockIndex& index);

  /// Distance (metres, NaN = never observed) at a voxel of the block, index -1 to kBlockSide + 1 on each
  /// axis.
  [[nodiscard]] float distance_m(const tsdf::VoxelIndex& local) const { return distances_m_[place(local)]; }
  /// Stored colour (BlockVoxels) at a voxel, index 0 on; 0 if no block is allocated.
  [[nodiscard]] std::uint32_t color(const tsdf::VoxelIndex& local) const;
  /// Gradient of the field (metres of distance per voxel) at a voxel, index 0 to kBlockSide on each axis:
  /// central differences, one-sided next to unobserved voxels, 0 along an axis with two unobserved
  /// neighbours. The voxel itself must be observed.
  [[nodiscard]] Vector3d gradient(const tsdf::VoxelIndex& local) const;

 private:
  static constexpr int kBefore = 1;
  static constexpr int kSide = kBefore + tsdf::kBlockSide + 2;

  static std::size_t place(const tsdf::VoxelIndex& local) {
    const auto at = (local.array() + kBefore).cast<std::size_t>();
    return at.x() + kSide * (at.y() + kSide * at.z());
  }
  static std::size_t neighbour(int x, int y, int z) {
    return static_cast<std::size_t>(x + 1 + 3 * (y + 1 + 3 * (z + 1)));
  }
  void load_row(int y, int z);

  const tsdf::TsdfVolume& volume_;
  tsdf::BlockSlots slots_;
  std::array<int, 27> around_{};  // slots of the block and of its neighbours, x fastest
  std::array<float, static_cast<std::size_t>(kSide* kSide* kSide)> distances_m_{};
};

}  // namespace fusebench::meshing
