// Open-addressing hash table from the lattice coordinates of a block to its storage slot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace fusebench::tsdf {

using BlockIndex = Eigen::Vector3i;  ///< lattice coordinates of a block: floor(voxel / 8)

/// Slots are numbered 0, 1, ... in the order of insertion. Concurrent lookups are allowed; concurrent
/// insertions are not.
class BlockTable {
 public:
  BlockTable() : entries_(kInitialCapacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t memory_bytes() const { return entries_.size() * sizeof(Entry); }

  /// Slot of a block, or -1.
  [[nodiscard]] int find(const BlockIndex& index) const { return entries_[probe(index)].slot; }

  /// Adds a block with the next slot; false if it exists already.
  bool insert(const BlockIndex& index);
  /// Removes all blocks and keeps the memory.
  void clear();

 private:
  static constexpr std::size_t kInitialCapacity = 1024;

  struct Entry {
    std::int32_t x = 0;
    std::int32_t y = 0;
    std::int32_t z = 0;
    std::int32_t slot = -1;  // -1 = free
  };

  [[nodiscard]] std::size_t probe(const BlockIndex& index) const {
    // Teschner et al. 2003 combine the axes with large primes; the multiplication spreads the result over the
    // high bits.
    const auto mixed = static_cast<std::uint32_t>(index.x()) * 73856093U ^
                       static_cast<std::uint32_t>(index.y()) * 19349663U ^
                       static_cast<std::uint32_t>(index.z()) * 83492791U;
    const std::size_t mask = entries_.size() - 1;
    std::size_t at = static_cast<std::size_t>((mixed * 0x9E3779B97F4A7C15ULL) >> 32) & mask;
    while (true) {
      const Entry& entry = entries_[at];
      if (entry.slot < 0 || (entry.x == index.x() && entry.y == index.y() && entry.z == index.z())) return at;
      at = (at + 1) & mask;
    }
  }
  void grow();

  std::vector<Entry> entries_;  // size: a power of two; at most half full
  std::size_t size_ = 0;
};

}  // namespace fusebench::tsdf
