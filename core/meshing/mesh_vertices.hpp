// Vertices of a mesh from the model: one on each edge of the lattice that the surface crosses.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/base/types.hpp"
#include "core/meshing/block_surroundings.hpp"
#include "core/tsdf/tsdf_volume.hpp"

namespace fusebench::meshing {

/// Each voxel owns the three edges that leave it upwards: number 3 * offset_in_block + axis.
inline constexpr std::size_t kBlockEdges = 3 * tsdf::kBlockVoxels;

/// The used edges of one block, and the number of the vertex on each.
struct BlockVertices {
  static constexpr std::size_t kWords = kBlockEdges / 64;
  std::array<std::uint64_t, kWords> used{};
  std::array<std::uint32_t, kWords> before{};  // vertices on all earlier edges

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

/// Writes vertices, block by block, into a mesh that has room for them.
class VertexWriter {
 public:
  VertexWriter(const tsdf::TsdfVolume& volume, Mesh& mesh)
      : voxel_m_(volume.voxel_m()), surroundings_(volume), mesh_(mesh) {}

  /// Those of one block. True if any has a colour.
  bool write(const tsdf::BlockIndex& block, const BlockVertices& vertices);

 private:
  bool write_vertex(const tsdf::BlockIndex& block, const tsdf::VoxelIndex& local, Eigen::Index axis,
                    std::size_t vertex);

  double voxel_m_;
  BlockSurroundings surroundings_;
  Mesh& mesh_;
};

}  // namespace fusebench::meshing
