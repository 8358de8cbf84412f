// The field at eight points.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/trilinear.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::tsdf {

/// Reads the field of a volume around a position. Coordinates are in voxels from origin_voxel(), which keeps
/// them small: the error of single precision is 1e-4 voxels at a thousand voxels from the origin. The volume
/// must have blocks, outlive the object, and not change.
class TsdfLanes {
 public:
  /// Blocks further than reach_m from the centre may be reported as absent.
  TsdfLanes(const TsdfVolume& volume, const Vector3d& centre_world, double reach_m);

  [[nodiscard]] const TsdfVolume& volume() const { return volume_; }
  /// World coordinates in voxels of the origin.
  [[nodiscard]] const Vector3d& origin_voxel() const { return origin_voxel_; }

  /// Storage locations of eight voxels.
  struct Location {
    simd::Int8 slot{};       ///< of the block, -1 = not allocated
    simd::Int8 offset{};     ///< in the block
    simd::Int8 no_region{};  ///< no block of its region (4x4x4 blocks) is allocated
  };
  [[nodiscard]] Location locate(const LatticePoints& voxel) const;
  /// Distances at voxels (metres); NaN if unobserved.
  [[nodiscard]] simd::Float8 distances_m(const Location& at) const { return distances_m(at.slot, at.offset); }

  /// Trilinear interpolation of the distance (metres); NaN if one of the eight neighbours is unobserved.
  [[nodiscard]] simd::Float8 sample(const simd::Points& at) const;

  /// Gradient of the field in metres per voxel: trilinear interpolation of the gradients at the eight
  /// neighbours (central differences, one-sided next to unobserved voxels). NaN if one of the eight is
  /// unobserved.
  [[nodiscard]] simd::Points gradient(const simd::Points& at) const;

 private:
  template <int kSide>
  class Cube;

  /// Share of a block coordinate along one axis in the indices of its slot.
  struct BlockAxis {
    simd::Int8 region;     ///< region coordinate
    simd::Int8 window;     ///< share in the index within the window
    simd::Int8 in_region;  ///< share in the index within the region
  };
  [[nodiscard]] BlockAxis block_axis(simd::Int8 block, int axis) const;
  [[nodiscard]] simd::Int8 regions(const BlockAxis& x, const BlockAxis& y, const BlockAxis& z) const;
  [[nodiscard]] simd::Int8 regions_by_table(const LatticePoints& region) const;
  [[nodiscard]] simd::Int8 slots(const BlockAxis& x, const BlockAxis& y, const BlockAxis& z) const;
  [[nodiscard]] simd::Int8 slots_in(simd::Int8 region, const BlockAxis& x, const BlockAxis& y,
                                    const BlockAxis& z) const;
  [[nodiscard]] simd::Float8 distances_m(simd::Int8 slot, simd::Int8 offset) const;
  /// Distances at an offset in a block and at the next one.
  [[nodiscard]] simd::Pairs pairs_m(simd::Int8 slot, simd::Int8 offset) const;

  const TsdfVolume& volume_;
  Eigen::Vector3i origin_region_;
  Vector3d origin_voxel_;
  int reach_;  // regions on each side of the origin
  // Number of each region in the window, -1 = none; empty if the window would be too large. Border regions
  // count as none, so lookups beyond the window use the table.
  std::vector<std::int32_t> window_;
  std::array<std::int32_t, 3> window_step_;  // stride of regions along each axis
};

/// The field in view of a camera; nothing if there is no block or the pose is outside the lattice.
[[nodiscard]] std::optional<TsdfLanes> field_in_view(const TsdfVolume& volume, const PinholeCamera& camera,
                                                     const SE3& T_world_camera,
                                                     const config::DepthConfig& depth);

// Inline, since it runs in every step of a ray.

inline TsdfLanes::BlockAxis TsdfLanes::block_axis(simd::Int8 block, int axis) const {
  const simd::Int8 region = block >> 2;
  const simd::Int8 within =
      simd::min(simd::max(region, simd::all_lanes(-reach_)), simd::all_lanes(reach_)) + reach_;
  return {region, within * window_step_[static_cast<std::size_t>(axis)], (block & 3) << (2 * axis)};
}

/// Numbers of regions, -1 = none.
inline simd::Int8 TsdfLanes::regions(const BlockAxis& x, const BlockAxis& y, const BlockAxis& z) const {
  return window_.empty() ? regions_by_table({x.region, y.region, z.region})
                         : simd::gather(window_.data(), x.window + y.window + z.window);
}

inline simd::Int8 TsdfLanes::slots(const BlockAxis& x, const BlockAxis& y, const BlockAxis& z) const {
  return slots_in(regions(x, y, z), x, y, z);
}

/// region: number of the region.
inline simd::Int8 TsdfLanes::slots_in(simd::Int8 region, const BlockAxis& x, const BlockAxis& y,
                                      const BlockAxis& z) const {
  return simd::gather(volume_.region_slots(), (region << 6) + x.in_region + y.in_region + z.in_region);
}

// Offsets of voxels fit in 32 bits: tsdf.max_blocks is less than 2^22.

inline simd::Float8 TsdfLanes::distances_m(simd::Int8 slot, simd::Int8 offset) const {
  return simd::gather(volume_.distances_m(), (slot << 9) + offset);
}

inline simd::Pairs TsdfLanes::pairs_m(simd::Int8 slot, simd::Int8 offset) const {
  return simd::gather_pairs(volume_.distances_m(), (slot << 9) + offset);
}

inline TsdfLanes::Location TsdfLanes::locate(const LatticePoints& voxel) const {
  const BlockAxis x = block_axis(voxel.x >> 3, 0);
  const BlockAxis y = block_axis(voxel.y >> 3, 1);
  const BlockAxis z = block_axis(voxel.z >> 3, 2);
  const simd::Int8 number = regions(x, y, z);
  const simd::Int8 slot = slots_in(number, x, y, z);
  return {slot, (voxel.x & 7) + ((voxel.y & 7) << 3) + ((voxel.z & 7) << 6), number < 0};
}

}  // namespace fusebench::tsdf
