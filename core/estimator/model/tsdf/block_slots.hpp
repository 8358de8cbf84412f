// Cached lookup of neighbouring blocks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::tsdf {

/// Slots of the blocks of a volume. Caches the last regions, so use one instance for each thread and part of
/// space. The volume must not change during its use.
class BlockSlots {
 public:
  explicit BlockSlots(const TsdfVolume& volume) : volume_(volume) {}

  /// The slot of a block, or -1.
  [[nodiscard]] int find(const BlockIndex& index) {
    const Eigen::Vector3i region = region_of(index);
    // Neighbouring regions differ in the parity of a coordinate, so they use different cache entries.
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
        Eigen::Vector3i::Constant(std::numeric_limits<int>::max());  // none: outside the lattice
    const std::int32_t* slots = nullptr;
  };

  const TsdfVolume& volume_;
  std::array<Remembered, 8> remembered_;
};

}  // namespace fusebench::tsdf
