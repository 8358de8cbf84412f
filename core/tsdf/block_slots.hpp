// Many lookups of blocks, close to each other.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::tsdf {

/// Slots of the blocks of a volume. Caches the regions that were looked up last, so use one instance for each
/// part of space and thread; the volume must not change meanwhile.
class BlockSlots {
 public:
  explicit BlockSlots(const TsdfVolume& volume) : volume_(volume) {}

  /// The slot of a block, or -1.
  [[nodiscard]] int find(const BlockIndex& index) {
    const Eigen::Vector3i region = region_of(index);
    // Neighbouring regions differ in the parity of a coordinate, so those around a point never evict each
    // other.
    Remembered& entry = remembered_[static_cast<std::size_t>((region.x() & 1) | (region.y() & 1) << 1 |
                                                             (region.z() & 1) << 2)];
    if (entry.region != region) {
      const auto number = static_cast<std::ptrdiff_t>(volume_.find_region(region));
      entry = {region, volume_.region_slots() + number * static_cast<std::ptrdiff_t>(kRegionBlocks)};
    }
    return entry.slots[place_in_region(index)];
  }

 private:
  struct Remembered {
    Eigen::Vector3i region =
        Eigen::Vector3i::Constant(std::numeric_limits<int>::max());  // none: nothing reaches that far
    const std::int32_t* slots = nullptr;
  };

  const TsdfVolume& volume_;
  std::array<Remembered, 8> remembered_;
};

}  // namespace fusebench::tsdf
