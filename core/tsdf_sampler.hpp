// Many lookups in the field, close to each other.
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "core/block_slots.hpp"
#include "core/tsdf_volume.hpp"

namespace fusebench {

/// Reads the field of a volume. Remembers where blocks are (BlockSlots), so use one for a ray or a region,
/// one a thread; the volume must not change meanwhile.
class TsdfSampler {
 public:
  explicit TsdfSampler(const TsdfVolume& volume)
      : volume_(volume), slots_(volume), per_voxel_(1.0 / volume.voxel_m()), reach_m_(volume.reach_m()) {}

  /// The slot of the block at these lattice coordinates, or -1.
  [[nodiscard]] int slot(const BlockIndex& index) { return slots_.find(index); }

  /// The distance at a voxel (metres); NaN if it was not observed.
  [[nodiscard]] float distance_m(const VoxelIndex& index) {
    const int found = slot(block_of(index));
    return found < 0 ? std::numeric_limits<float>::quiet_NaN()
                     : static_cast<float>(block_m(found)[offset_in_block(index)]);
  }

  /// All of a voxel; one that was never observed where no block is allocated.
  [[nodiscard]] Voxel voxel(const VoxelIndex& index) {
    const int found = slot(block_of(index));
    return found < 0 ? Voxel{} : volume_.voxel(static_cast<std::size_t>(found), offset_in_block(index));
  }

  /// Trilinear interpolation of the distance at a world point (metres); invalid unless all eight neighbours
  /// were observed.
  [[nodiscard]] TsdfSample sample(const Vector3d& point_world);

 private:
  struct Cell {
    VoxelIndex base;                // lower corner
    Vector3d fraction;              // position in the cell, in [0, 1)
    std::array<float, 8> corner_m;  // bit 0 of the number: x, bit 1: y, bit 2: z
  };

  [[nodiscard]] const Half* block_m(int slot) const {
    return volume_.distances_m() + static_cast<std::size_t>(slot) * kBlockVoxels;
  }
  /// False where a corner was not observed.
  [[nodiscard]] bool find_cell(const Vector3d& point_world, Cell& cell);

  const TsdfVolume& volume_;
  BlockSlots slots_;
  double per_voxel_;
  double reach_m_;
};

}  // namespace fusebench
