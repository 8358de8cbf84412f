// The field at eight points at once.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/trilinear.hpp"
#include "core/tsdf_volume.hpp"

namespace fusebench {

/// Reads the field of a volume around a place. Coordinates are in voxels from origin_voxel(), which keeps
/// them small, so that single precision is enough: 1e-4 voxels at a thousand voxels from the origin. The
/// volume must have blocks, outlive it, and not change meanwhile.
class TsdfLanes {
 public:
  /// Further than reach_m from the centre there may seem to be no blocks.
  TsdfLanes(const TsdfVolume& volume, const Vector3d& centre_world, double reach_m);

  /// World coordinates in voxels of the origin.
  [[nodiscard]] const Vector3d& origin_voxel() const { return origin_voxel_; }

  /// Where voxels are stored.
  struct Location {
    Int8 slot{};       ///< of the block, -1 = not allocated
    Int8 offset{};     ///< in the block
    Int8 no_region{};  ///< no block of its region (4x4x4 blocks) is allocated
  };
  [[nodiscard]] Location locate(const LatticePoints& voxel) const;
  /// Distances at voxels (metres); NaN where they were not observed.
  [[nodiscard]] Float8 distances_m(const Location& at) const { return distances_m(at.slot, at.offset); }

  /// Trilinear interpolation of the distance (metres); NaN where one of the eight neighbours was not
  /// observed.
  [[nodiscard]] Float8 sample(const Points& at) const;

  /// Gradient of the field in metres per voxel: trilinear interpolation of that at the eight neighbours, by
  /// central differences, one-sided next to unobserved voxels. NaN where one of the eight was not observed.
  [[nodiscard]] Points gradient(const Points& at) const;

 private:
  template <int kSide>
  class Cube;

  [[nodiscard]] Int8 regions(const LatticePoints& region) const;
  [[nodiscard]] Int8 regions_by_table(const LatticePoints& region) const;
  [[nodiscard]] Int8 slots(const LatticePoints& block) const;
  [[nodiscard]] Float8 distances_m(Int8 slot, Int8 offset) const;
  /// At an offset in a block, and at the next one.
  [[nodiscard]] Pairs pairs_m(Int8 slot, Int8 offset) const;

  const TsdfVolume& volume_;
  Eigen::Vector3i origin_region_;
  Vector3d origin_voxel_;
  int reach_;                         // regions on either side of the origin's
  std::vector<std::int32_t> window_;  // number of each region there, -1 = none; empty if there were too many
};

/// The field as far as a camera sees; nothing if there is no block, or the pose is no place in the lattice.
[[nodiscard]] std::optional<TsdfLanes> field_in_view(const TsdfVolume& volume, const PinholeCamera& camera,
                                                     const SE3& T_world_camera, const DepthConfig& depth);

// Inline: one step of a ray after the other asks for them.

/// Numbers of regions, -1 = none.
inline Int8 TsdfLanes::regions(const LatticePoints& region) const {
  if (!window_.empty()) {
    const Int8 x = region.x + reach_;
    const Int8 y = region.y + reach_;
    const Int8 z = region.z + reach_;
    const int last = 2 * reach_;
    const Int8 inside = ((x | y | z) >= 0) & (x <= last) & (y <= last) & (z <= last);
    const Int8 found = gather(window_.data(), inside ? x + (last + 1) * (y + (last + 1) * z) : Int8{});
    return inside ? found : all_lanes(-1);
  }
  return regions_by_table(region);
}

inline Int8 TsdfLanes::slots(const LatticePoints& block) const {
  const Int8 number = regions({block.x >> 2, block.y >> 2, block.z >> 2});
  const Int8 offset = (block.x & 3) + ((block.y & 3) << 2) + ((block.z & 3) << 4);
  const Int8 found = gather(volume_.region_slots(), (number >= 0 ? number << 6 : Int8{}) + offset);
  return number >= 0 ? found : all_lanes(-1);
}

inline Float8 TsdfLanes::distances_m(Int8 slot, Int8 offset) const { return pairs_m(slot, offset).first; }

inline Pairs TsdfLanes::pairs_m(Int8 slot, Int8 offset) const {
  const Int8 there = slot >= 0;
  const Pairs found_m = gather_pairs(volume_.distances_m(), (there ? slot << 9 : Int8{}) + offset);
  const Float8 unknown = not_a_number();
  return {there ? found_m.first : unknown, there ? found_m.second : unknown};
}

inline TsdfLanes::Location TsdfLanes::locate(const LatticePoints& voxel) const {
  const LatticePoints block = {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
  const Int8 number = regions({block.x >> 2, block.y >> 2, block.z >> 2});
  const Int8 no_region = number < 0;
  const Int8 in_region = (block.x & 3) + ((block.y & 3) << 2) + ((block.z & 3) << 4);
  const Int8 found = gather(volume_.region_slots(), (no_region ? Int8{} : number << 6) + in_region);
  return {no_region ? all_lanes(-1) : found, (voxel.x & 7) + ((voxel.y & 7) << 3) + ((voxel.z & 7) << 6),
          no_region};
}

}  // namespace fusebench
