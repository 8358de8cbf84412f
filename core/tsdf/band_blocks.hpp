// Which blocks of the lattice a depth image touches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/parallel.hpp"
#include "core/base/types.hpp"
#include "core/config/groups/config_fwd.hpp"
#include "core/tsdf/block_table.hpp"

namespace fusebench::tsdf {

/// Half width of the band (metres) around a measurement: tsdf.truncation_m, two voxels, or
/// tsdf.truncation_sigmas of the depth noise, whichever is most.
[[nodiscard]] double half_band_m(double depth_m, const config::TsdfConfig& tsdf,
                                 const config::DepthConfig& depth);

/// A set of blocks in the order in which they were first met.
class OrderedBlocks {
 public:
  OrderedBlocks() { clear_recent(); }

  void clear();
  void add(const BlockIndex& index) {
    // Most rays run through the blocks of the rays before.
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

/// The blocks of one depth image after the other; keeps its memory.
class BandBlocks {
 public:
  /// Finds every block that a ray of a measured pixel passes from half a band in front of the measurement to
  /// as far behind it (both along z). Depth outside [min_m, max_m] of `depth` is skipped. Where a block is at
  /// least kFinePixels wide in the image as far away as max_m, every fourth pixel of every fourth row stands
  /// for its neighbours, every second one where it is half as wide: of a surface they may miss corners, half
  /// a block wide. Which pixels these are changes from row to row and with the number of the frame, so that a
  /// thin structure is not missed systematically. Single precision from the camera on: a ray that misses a
  /// corner of a block by less than a micrometre may count as a hit. Ends soon after more than
  /// tsdf.max_blocks are found, which is more than the model can take.
  void find(const DepthImage& depth_m, const PinholeCamera& camera, const SE3& T_world_camera, double block_m,
            const config::TsdfConfig& tsdf, const config::DepthConfig& depth, std::uint32_t frame_number,
            const Workers& workers);

  static constexpr double kFinePixels = 8;

  /// Those found, once each, in the order of the pixels (row-major), then from front to back. The same for
  /// every number of threads.
  [[nodiscard]] const std::vector<BlockIndex>& blocks() const { return found_.blocks(); }

 private:
  std::vector<OrderedBlocks> chunks_;
  OrderedBlocks found_;
};

}  // namespace fusebench::tsdf
