// Vertices of a mesh: one on each lattice edge that crosses the surface.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/types.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::meshing {

/// Each voxel owns the edges to its upper neighbours: number 3 * offset_in_block + axis.
inline constexpr std::size_t kBlockEdges = 3 * tsdf::kBlockVoxels;

/// Used edges of one block with the numbers of their vertices.
struct BlockVertices {
  static constexpr std::size_t kWords = kBlockEdges / 64;
  std::array<std::uint64_t, kWords> used{};
  std::array<std::uint32_t, kWords> before{};  // number of vertices on earlier edges

  [[nodiscard]] bool any() const {
    return std::any_of(used.begin(), used.end(), [](std::uint64_t word) { return word != 0; });
  }
  void number(std::uint32_t& count) {
    for (std::size_t word = 0; word < kWords; ++word) {
      before[word] = count;
      count += static_cast<std::uint32_t>(std::popcount(used[word]));
    }
  }
  [[nodiscard]] std::uint32_t vertex(std::size_t edge) const {
    const std::uint64_t earlier = used[edge / 64] & ((std::uint64_t{1} << edge % 64) - 1);
    return before[edge / 64] + static_cast<std::uint32_t>(std::popcount(earlier));
  }
};

/// Writes the vertices of blocks into a mesh of sufficient size. slots: of the blocks in the volume. True if
/// any vertex has a colour.
bool write_vertices(const tsdf::TsdfVolume& volume, std::span<const std::size_t> slots,
                    std::span<const BlockVertices> vertices, Mesh& mesh);

}  // namespace fusebench::meshing
