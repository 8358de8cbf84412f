// Blocks of the lattice that a depth image touches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/estimator/model/tsdf/block_table.hpp"

namespace fusebench::tsdf {

/// Half width of the band (metres) around a measurement: the largest of tsdf.truncation_m, two voxels, and
/// tsdf.truncation_sigmas of the depth noise.
[[nodiscard]] double half_band_m(double depth_m, const config::TsdfConfig& tsdf,
                                 const config::DepthConfig& depth);

/// A set of blocks in the order of insertion.
class OrderedBlocks {
 public:
  OrderedBlocks() { clear_recent(); }

  void clear();
  void add(const BlockIndex& index) {
    // Most rays pass the same blocks as the previous rays.
    BlockIndex& recent =
        recent_[static_cast<std::size_t>((index.x() & 3) | (index.y() & 3) << 2 | (index.z() & 3) << 4)];
    if (index == recent) return;
    recent = index;
    if (table_.insert(index)) blocks_.push_back(index);
  }
  [[nodiscard]] const std::vector<BlockIndex>& blocks() const { return blocks_; }

 private:
  void clear_recent();

  BlockTable table_;
  std::vector<BlockIndex> blocks_;
  std::array<BlockIndex, 64> recent_;
};

/// The blocks of a depth image; reuses its memory.
class BandBlocks {
 public:
  /// Finds all blocks that the rays of measured pixels pass within half a band of the measurement, in front
  /// and behind (along z). Skips depth outside [min_m, max_m] of `depth`. If a block at max_m is at least
  /// kFinePixels wide in the image, only every fourth pixel of every fourth row is used, at half that width
  /// every second one. This may miss corners of a surface, half a block wide. The selected pixels change with
  /// row and frame number, so thin structures are not missed systematically. Single precision relative to the
  /// camera: a ray may count as a hit if it misses a corner by less than a micrometre. Stops soon after the
  /// number of blocks exceeds tsdf.max_blocks.
  void find(const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera, double block_m,
            const config::TsdfConfig& tsdf, const config::DepthConfig& depth, std::uint32_t frame_number,
            const Workers& workers);

  static constexpr double kFinePixels = 8;

  /// The blocks found, without duplicates, in the order of the pixels (row-major), then from front to back.
  /// Does not depend on the number of threads.
  [[nodiscard]] const std::vector<BlockIndex>& blocks() const { return found_.blocks(); }

 private:
  std::vector<OrderedBlocks> chunks_;
  OrderedBlocks found_;
};

}  // namespace fusebench::tsdf
