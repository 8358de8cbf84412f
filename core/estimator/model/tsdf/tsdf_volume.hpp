// The model: a truncated signed distance field (Curless & Levoy 1996) with colour, in a hash of 8x8x8 blocks
// (Niessner et al. 2013). Distances are positive in front of the surface (towards the camera).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/growing_array.hpp"
#include "core/base/parallel.hpp"
#include "core/base/simd/half_lanes.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/band_blocks.hpp"
#include "core/estimator/model/tsdf/block_table.hpp"

namespace fusebench::tsdf {

inline constexpr int kBlockSide = 8;   ///< voxels
inline constexpr int kRegionSide = 4;  ///< blocks
inline constexpr std::size_t kRegionBlocks = kRegionSide * kRegionSide * kRegionSide;
inline constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;

/// One sample of the field at the world point (ix, iy, iz) * voxel_m.
///
/// The distance is in metres, clamped to the truncation band of each measurement. The band grows with depth,
/// so distances in metres from near and far views can be averaged, but shares of their bands could not. The
/// band is at least two voxels, so the voxels next to the surface are never clamped and the zero level is not
/// affected.
struct Voxel {
  float distance_m = std::numeric_limits<float>::quiet_NaN();  ///< signed; NaN = never observed
  float weight = 0.0F;                                         ///< 0 = never observed
  Rgb color{};                                                 ///< running mean
  std::uint8_t color_count = 0;  ///< number of averaged observations (saturates); 0 = no colour
};

using VoxelIndex = Eigen::Vector3i;  ///< lattice coordinates of a voxel

/// Storage location of a voxel.
struct VoxelPlace {
  std::size_t slot = 0;    ///< of its block
  std::size_t offset = 0;  ///< within the block, see offset_in_block()
};

/// Storage of one block: pointers to kBlockVoxels values each, x fastest, then y, then z. Values that are
/// read together are stored together: ray casting reads distances only, and colour is seldom read.
///
/// Half precision (eleven bits) is sufficient: rounding of a distance of one centimetre is at most 4
/// micrometres, far below the depth noise, and the noise keeps the running mean moving. A weight below 1/4096
/// of the sum does not increase it, so distant measurements saturate before tsdf.max_weight.
struct BlockVoxels {
  simd::Half* distance_m = nullptr;
  simd::Half* weight = nullptr;
  std::uint32_t* color = nullptr;  ///< bytes from the lowest: red, green, blue, count
};

/// A moved-from volume can only be assigned or destroyed.
class TsdfVolume {
 public:
  explicit TsdfVolume(const config::TsdfConfig& config);

  /// Fuses one frame. Allocates the blocks along each measured ray within the truncation band. Each voxel of
  /// these blocks averages the projective distance (depth at the nearest pixel minus its own z-depth, clamped
  /// to the band). Voxels farther behind the surface than the band are not updated.
  ///
  /// The weight of a measurement is v^2 / (v^2 + sigma(depth)^2), with v = voxel_m for errors that averaging
  /// does not reduce. Behind the surface it also decreases linearly to 0 over the back half of the band (as
  /// in Bylow et al. 2013), since there is free space behind thin parts and edges. Weights saturate at
  /// tsdf.max_weight. Colour is updated where |distance| < band / 2.
  ///
  /// Depth outside [min_m, max_m] of `depth` (and NaN) is ignored, as is colour if the frame has none. depth
  /// must have the size of the camera. The storage order follows the pixels and so depends on the frames
  /// only. Error run_failed: tsdf.max_blocks is reached (the message names it), or the pose is outside the
  /// lattice (NaN, too far); the volume is then unchanged by this frame.
  [[nodiscard]] Result<void> integrate(const RgbdFrame& frame, const PinholeCamera& camera,
                                       const SE3& T_world_camera, const config::DepthConfig& depth,
                                       const Workers& workers);

  [[nodiscard]] double voxel_m() const { return voxel_m_; }
  [[nodiscard]] std::uint32_t frame_count() const { return frame_count_; }  ///< fused so far
  [[nodiscard]] std::size_t block_count() const { return indices_.size(); }
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] const std::vector<BlockIndex>& block_indices() const { return indices_; }
  /// The voxel at an offset (offset_in_block) of a block.
  [[nodiscard]] Voxel voxel(std::size_t slot, std::size_t offset) const;
  /// Distances of all blocks by slot, kBlockVoxels each; NaN = never observed. Slot -1 (no block) is readable
  /// and unobserved, as is one value beyond the last, see gather().
  [[nodiscard]] const simd::Half* distances_m() const { return distances_m_.data() + kBlockVoxels; }
  [[nodiscard]] const simd::Half* weights() const { return weights_.data(); }
  /// Colours by slot from 0 on, in the layout of BlockVoxels, as weights().
  [[nodiscard]] const std::uint32_t* colors() const { return colors_.data(); }

  /// Stamp of the last frame that touched a block.
  [[nodiscard]] std::int64_t last_fused_ns(std::size_t slot) const { return last_fused_ns_[slot]; }

  /// Slot of a block in storage order, or -1.
  [[nodiscard]] int find_block(const BlockIndex& index) const { return table_.find(index); }
  /// Storage location of the voxel nearest to a world point (metres, closer than reach_m()); nothing if its
  /// block is not allocated.
  [[nodiscard]] std::optional<VoxelPlace> nearest_voxel(const Vector3d& point_world) const;
  /// Number of a region with an allocated block, or -1; regions are cubes of 4x4x4 blocks: floor(block / 4).
  [[nodiscard]] int find_region(const Eigen::Vector3i& region) const { return regions_.find(region); }
  [[nodiscard]] const std::vector<Eigen::Vector3i>& region_indices() const { return region_indices_; }
  /// Slots of the 64 blocks (x fastest) of each region by its number, -1 = none. Number -1 (no region) is
  /// readable and has no blocks.
  [[nodiscard]] const std::int32_t* region_slots() const { return region_slots_.data() + kRegionBlocks; }
  /// Half width of the updated band (metres) at this depth: the largest of tsdf.truncation_m, two voxels, and
  /// tsdf.truncation_sigmas of the depth noise.
  [[nodiscard]] double truncation_m(double depth_m, const config::DepthConfig& depth) const;
  /// Weight of one measurement of a surface at this depth, see integrate().
  [[nodiscard]] double measurement_weight(double depth_m, const config::DepthConfig& depth) const;
  /// Limit of the coordinates of points (metres, absolute value).
  [[nodiscard]] double reach_m() const { return voxel_m_ * (1 << 30); }

 private:
  [[nodiscard]] Result<void> allocate();
  void add_block(const BlockIndex& index);
  [[nodiscard]] BlockVoxels block(std::size_t slot);

  std::shared_ptr<const config::TsdfConfig> config_;
  double voxel_m_;
  BlockTable table_;    // block -> slot
  BlockTable regions_;  // regions with blocks; rays cross empty regions in large steps
  std::vector<Eigen::Vector3i> region_indices_;
  std::vector<std::int32_t> region_slots_;  // by number + 1
  std::vector<BlockIndex> indices_;         // by slot
  std::vector<std::int64_t> last_fused_ns_;
  GrowingArray<simd::Half> distances_m_;  // by slot + 1
  GrowingArray<simd::Half> weights_;
  GrowingArray<std::uint32_t> colors_;
  BandBlocks touched_;  // by the last frame
  std::vector<int> touched_slots_;
  std::uint32_t frame_count_ = 0;
};

/// Lattice arithmetic. In C++20, right shifts of negative numbers round down, as floor() does.
[[nodiscard]] inline BlockIndex block_of(const VoxelIndex& voxel) {
  return {voxel.x() >> 3, voxel.y() >> 3, voxel.z() >> 3};
}
[[nodiscard]] inline Eigen::Vector3i region_of(const BlockIndex& block) {
  return {block.x() >> 2, block.y() >> 2, block.z() >> 2};
}
/// Index of a block among the kRegionBlocks of its region.
[[nodiscard]] inline std::size_t place_in_region(const BlockIndex& block) {
  return static_cast<std::size_t>((block.x() & 3) +
                                  kRegionSide * ((block.y() & 3) + kRegionSide * (block.z() & 3)));
}
[[nodiscard]] inline std::size_t offset_in_block(const VoxelIndex& voxel) {
  return static_cast<std::size_t>((voxel.x() & 7) +
                                  kBlockSide * ((voxel.y() & 7) + kBlockSide * (voxel.z() & 7)));
}

inline std::optional<VoxelPlace> TsdfVolume::nearest_voxel(const Vector3d& point_world) const {
  const VoxelIndex voxel = (point_world / voxel_m_).array().round().matrix().cast<int>();
  const int slot = find_block(block_of(voxel));
  if (slot < 0) return std::nullopt;
  return VoxelPlace{static_cast<std::size_t>(slot), offset_in_block(voxel)};
}

}  // namespace fusebench::tsdf
