// The field of a model at one place in double precision: what the field at eight
// (core/estimator/model/tsdf/tsdf_lanes.hpp) and the rays through it are held against.
#pragma once

#include <cmath>
#include <optional>

#include "core/estimator/model/tsdf/block_slots.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::testing {

/// The voxel at a lattice point; nothing where no block is allocated.
inline std::optional<tsdf::Voxel> find_voxel(const tsdf::TsdfVolume& volume, const tsdf::VoxelIndex& index) {
  const int slot = volume.find_block(tsdf::block_of(index));
  if (slot < 0) return std::nullopt;
  return volume.voxel(static_cast<std::size_t>(slot), tsdf::offset_in_block(index));
}

/// The volume must outlive it and not change meanwhile.
class PlainField {
 public:
  explicit PlainField(const tsdf::TsdfVolume& volume) : volume_(volume), slots_(volume) {}

  /// Trilinear interpolation of the signed distance at a world point (metres); nothing unless all eight
  /// neighbours were observed.
  [[nodiscard]] std::optional<double> distance_m(const Vector3d& point_world) {
    if (!(point_world.cwiseAbs().maxCoeff() < volume_.reach_m())) return std::nullopt;
    const Vector3d lattice = point_world / volume_.voxel_m();
    const tsdf::VoxelIndex base = lattice.array().floor().matrix().cast<int>();
    double sum_m = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const tsdf::VoxelIndex at = base + tsdf::VoxelIndex(corner & 1, (corner >> 1) & 1, corner >> 2);
      const int slot = slots_.find(tsdf::block_of(at));
      if (slot < 0) return std::nullopt;
      const simd::Half* const block_m =
          volume_.distances_m() + static_cast<std::ptrdiff_t>(slot) * tsdf::kBlockVoxels;
      const auto corner_m = static_cast<float>(block_m[tsdf::offset_in_block(at)]);
      if (std::isnan(corner_m)) return std::nullopt;
      const Vector3d apart = (lattice - at.cast<double>()).cwiseAbs();
      sum_m += (1 - apart.x()) * (1 - apart.y()) * (1 - apart.z()) * static_cast<double>(corner_m);
    }
    return sum_m;
  }

 private:
  const tsdf::TsdfVolume& volume_;
  tsdf::BlockSlots slots_;
};

}  // namespace fusebench::testing
