#include "core/estimator/model/meshing/marching_cubes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <tuple>
#include <vector>

#include "core/base/bits.hpp"
#include "core/estimator/model/meshing/marching_cubes_table.hpp"
#include "core/estimator/model/meshing/mesh_vertices.hpp"
#include "core/estimator/model/tsdf/block_slots.hpp"

namespace fusebench::meshing {
namespace {

constexpr std::size_t kBlocksPerChunk = 16;

// Number of a lattice edge relative to a block. n: which of the eight blocks at the upper corner has the
// edge's lower end; the number is n * kNeighbourEdges + offset of the end in its block * 3 + axis.
using LocalEdge = std::uint16_t;
using EdgeTriangle = std::array<LocalEdge, 3>;
constexpr std::size_t kNeighbourEdges = 2048;
static_assert(kBlockEdges <= kNeighbourEdges && 8 * kNeighbourEdges <= 65536);

// Triangles of a chunk of blocks.
struct Surface {
  // A non-empty block.
  struct Block {
    std::array<std::uint32_t, 8> neighbour_ranks{};
    std::size_t triangles_end = 0;
  };
  // Calls visit(rank of the block of the edge, edge in it) for each corner of each triangle.
  template <class Visit>
  void for_each_corner(const Visit& visit) const {
    std::size_t i = 0;
    for (const Block& block : blocks) {
      for (; i < block.triangles_end; ++i) {
        for (const LocalEdge edge : triangles[i])
          visit(block.neighbour_ranks[edge / kNeighbourEdges], edge % kNeighbourEdges);
      }
    }
  }

  std::vector<Block> blocks;
  std::vector<EdgeTriangle> triangles;  // concatenated, block by block
};

// The lowest bit of byte i is bit i of `bits`.
std::uint64_t byte_each(unsigned bits) {
  static constexpr auto kTable = [] {
    std::array<std::uint64_t, 256> table{};
    for (unsigned entry = 0; entry < table.size(); ++entry) {
      for (unsigned bit = 0; bit < 8; ++bit) table[entry] |= std::uint64_t{entry >> bit & 1} << (8 * bit);
    }
    return table;
  }();
  return kTable[bits];
}

// Blocks sorted by index (z, then y, then x), so that a mesh does not depend on the storage order.
struct SortedBlocks {
  explicit SortedBlocks(const tsdf::TsdfVolume& volume)
      : slots(volume.block_count()), ranks(volume.block_count()) {
    const std::vector<tsdf::BlockIndex>& indices = volume.block_indices();
    std::iota(slots.begin(), slots.end(), std::size_t{0});
    std::sort(slots.begin(), slots.end(), [&](std::size_t a, std::size_t b) {
      const tsdf::BlockIndex& p = indices[a];
      const tsdf::BlockIndex& q = indices[b];
      return std::tuple(p.z(), p.y(), p.x()) < std::tuple(q.z(), q.y(), q.x());
    });
    for (std::size_t rank = 0; rank < slots.size(); ++rank)
      ranks[slots[rank]] = static_cast<std::uint32_t>(rank);
  }
  std::vector<std::size_t> slots;    // by rank
  std::vector<std::uint32_t> ranks;  // by slot
};

// Triangles of the cells whose lower corner is in one block.
class BlockCells {
 public:
  BlockCells(const tsdf::TsdfVolume& volume, const SortedBlocks& sorted, double min_weight)
      : volume_(volume), slots_(volume), sorted_(sorted), min_weight_(static_cast<float>(min_weight)) {}

  void append(std::size_t rank, Surface& surface) {
    load(volume_.block_indices()[sorted_.slots[rank]]);
    if (!has_both_signs()) return;
    const std::size_t before = surface.triangles.size();
    for (int z = 0; z < tsdf::kBlockSide; ++z) {
      for (int y = 0; y < tsdf::kBlockSide; ++y) {
        const Row row = crossed_cells(y, z);
        for_each_bit(row.crossed, [&](std::size_t bit) {
          append_cell({static_cast<int>(bit) / 8, y, z}, row.patterns >> bit & 0xFF, surface.triangles);
        });
      }
    }
    if (surface.triangles.size() > before)
      surface.blocks.push_back({neighbour_ranks_, surface.triangles.size()});
  }

 private:
  static constexpr std::size_t kSide =
      tsdf::kBlockSide + 1;  // includes the upper corners of the last cells, in the next block
  static constexpr std::size_t kSlice = kSide * kSide;
  static constexpr std::array<std::size_t, 8> kCorner = {
      0, 1, kSide, kSide + 1, kSlice, kSlice + 1, kSlice + kSide, kSlice + kSide + 1};
  static constexpr std::uint8_t kObserved = 1;
  static constexpr std::uint8_t kInside = 2;

  static std::size_t neighbour_of(const tsdf::VoxelIndex& local) {
    return static_cast<std::size_t>(local.x() >> 3 | (local.y() >> 3) << 1 | (local.z() >> 3) << 2);
  }

  void load(const tsdf::BlockIndex& index) {
    sign_.fill(0);
    for (std::size_t n = 0; n < 8; ++n) {
      const int slot = slots_.find(index + tsdf::BlockIndex(n & 1 ? 1 : 0, n & 2 ? 1 : 0, n & 4 ? 1 : 0));
      // A missing block has no used edges, since its voxels are unobserved.
      neighbour_ranks_[n] = slot < 0 ? 0 : sorted_.ranks[static_cast<std::size_t>(slot)];
      if (slot >= 0) load_neighbour(n, static_cast<std::size_t>(slot));
    }
  }

  // Loads the signs at the corners of the cells: all voxels of the own block, one layer of the neighbours.
  void load_neighbour(std::size_t n, std::size_t slot) {
    const auto range = [&](std::size_t bit) -> std::size_t { return (n & bit) != 0 ? 1 : tsdf::kBlockSide; };
    const simd::Half* const distances_m = volume_.distances_m() + slot * tsdf::kBlockVoxels;
    const simd::Half* const weights = volume_.weights() + slot * tsdf::kBlockVoxels;
    const std::size_t begin = (n & 1 ? tsdf::kBlockSide : 0) + (n & 2 ? tsdf::kBlockSide * kSide : 0) +
                              (n & 4 ? tsdf::kBlockSide * kSlice : 0);
    for (std::size_t z = 0; z < range(4); ++z) {
      for (std::size_t y = 0; y < range(2); ++y) {
        std::uint8_t* const signs = &sign_[begin + kSide * y + kSlice * z];
        const std::size_t row = tsdf::kBlockSide * (y + tsdf::kBlockSide * z);
        const std::uint64_t of_row = row_signs(distances_m + row, weights + row);
        std::memcpy(signs, &of_row, range(1));
      }
    }
  }

  // Fast rejection: most blocks have voxels on one side only.
  [[nodiscard]] bool has_both_signs() const {
    std::uint8_t inside = 0;
    std::uint8_t outside = 0;
    for (const std::uint8_t sign : sign_) {
      inside |= static_cast<std::uint8_t>(sign == (kObserved | kInside));
      outside |= static_cast<std::uint8_t>(sign == kObserved);
    }
    return inside != 0 && outside != 0;
  }

  // The signs of eight voxels, a byte each.
  [[nodiscard]] std::uint64_t row_signs(const simd::Half* distances_m, const simd::Half* weights) const {
    static_assert(std::endian::native == std::endian::little);
    static_assert(tsdf::kBlockSide == simd::kLanes && kObserved == 1 && kInside == 2);
    const simd::Float8 distance_m = simd::load(distances_m);
    const simd::Int8 seen = (distance_m == distance_m) & (simd::load(weights) >= min_weight_);
    return byte_each(simd::lane_bits(seen)) | byte_each(simd::lane_bits(seen & (distance_m < 0.0F))) << 1;
  }

  // A row of cells, one byte each.
  struct Row {
    std::uint64_t crossed;   // 1: all corners are observed, with both signs
    std::uint64_t patterns;  // bit c: corner c is inside
  };
  [[nodiscard]] Row crossed_cells(int y, int z) const {
    constexpr std::uint64_t kOnes = 0x0101010101010101U;
    const std::size_t first = kSide * static_cast<std::size_t>(y) + kSlice * static_cast<std::size_t>(z);
    std::uint64_t all = ~std::uint64_t{0};
    std::uint64_t some = 0;
    std::uint64_t patterns = 0;
    for (std::size_t corner = 0; corner < kCorner.size(); ++corner) {
      std::uint64_t signs = 0;
      std::memcpy(&signs, &sign_[first + kCorner[corner]], sizeof(signs));
      all &= signs;
      some |= signs;
      patterns |= (signs >> 1 & kOnes) << corner;
    }
    return {all & ((some & ~all) >> 1) & kOnes, patterns};
  }

  void append_cell(const tsdf::VoxelIndex& base, std::size_t pattern,
                   std::vector<EdgeTriangle>& triangles) const {
    if (base.maxCoeff() < tsdf::kBlockSide - 1) {  // all edges belong to the own block: two of three cells
      const auto first = static_cast<LocalEdge>(3 * tsdf::offset_in_block(base));
      for (const CellTriangle& triangle : triangles_[pattern]) {
        triangles.push_back(
            {own_edge(first, triangle[0]), own_edge(first, triangle[1]), own_edge(first, triangle[2])});
      }
      return;
    }
    for (const CellTriangle& triangle : triangles_[pattern]) {
      triangles.push_back(
          {local_edge(base, triangle[0]), local_edge(base, triangle[1]), local_edge(base, triangle[2])});
    }
  }

  [[nodiscard]] LocalEdge own_edge(LocalEdge first, std::uint8_t cell_edge) const {
    return static_cast<LocalEdge>(first + edge_offsets_[cell_edge]);
  }
  [[nodiscard]] static LocalEdge local_edge(const tsdf::VoxelIndex& base, std::uint8_t cell_edge) {
    const CellEdge& edge = cell_edges()[cell_edge];
    const tsdf::VoxelIndex local =
        base + tsdf::VoxelIndex(edge.from & 1, (edge.from >> 1) & 1, edge.from >> 2);
    return static_cast<LocalEdge>(neighbour_of(local) * kNeighbourEdges + tsdf::offset_in_block(local) * 3 +
                                  edge.axis);
  }
  // Offsets from the first edge of the lowest corner of a cell to its edges, if all belong to one block.
  static std::array<LocalEdge, 12> edge_offsets() {
    std::array<LocalEdge, 12> offsets{};
    for (std::uint8_t edge = 0; edge < offsets.size(); ++edge) offsets[edge] = local_edge({0, 0, 0}, edge);
    return offsets;
  }

  const tsdf::TsdfVolume& volume_;
  tsdf::BlockSlots slots_;
  const SortedBlocks& sorted_;
  float min_weight_;
  const std::array<std::vector<CellTriangle>, 256>& triangles_ = cell_triangles();
  const std::array<LocalEdge, 12> edge_offsets_ = edge_offsets();
  std::array<std::uint32_t, 8> neighbour_ranks_{};
  std::array<std::uint8_t, kSide * kSide * kSide> sign_{};
};

}  // namespace

Mesh extract_mesh(const tsdf::TsdfVolume& volume, double min_weight, const Workers& workers) {
  const SortedBlocks sorted(volume);
  const std::size_t blocks = sorted.slots.size();
  const auto surfaces =
      workers.map_chunks<Surface>(blocks, kBlocksPerChunk, [&](std::size_t begin, std::size_t end) {
        BlockCells cells(volume, sorted, min_weight);
        Surface surface;
        for (std::size_t rank = begin; rank < end; ++rank) cells.append(rank, surface);
        return surface;
      });

  std::vector<BlockVertices> vertices(blocks);
  std::vector<std::size_t> first_triangle(surfaces.size() + 1, 0);
  for (std::size_t chunk = 0; chunk < surfaces.size(); ++chunk) {
    first_triangle[chunk + 1] = first_triangle[chunk] + surfaces[chunk].triangles.size();
    surfaces[chunk].for_each_corner([&](std::size_t rank, std::size_t edge) {
      vertices[rank].used[edge / 64] |= std::uint64_t{1} << edge % 64;
    });
  }
  std::uint32_t vertex_count = 0;
  for (BlockVertices& block : vertices) block.number(vertex_count);

  Mesh mesh;
  mesh.vertices.resize(vertex_count);
  mesh.normals.resize(vertex_count);
  mesh.colors.resize(vertex_count);
  mesh.triangles.resize(first_triangle.back());
  const auto colored =
      workers.map_chunks<char>(blocks, kBlocksPerChunk, [&](std::size_t begin, std::size_t end) {
        const std::size_t count = end - begin;
        const bool any = write_vertices(volume, std::span(sorted.slots).subspan(begin, count),
                                        std::span(vertices).subspan(begin, count), mesh);
        const std::size_t chunk = begin / kBlocksPerChunk;
        std::size_t corner = 3 * first_triangle[chunk];
        surfaces[chunk].for_each_corner([&](std::size_t rank, std::size_t edge) {
          mesh.triangles[corner / 3][corner % 3] = vertices[rank].vertex(edge);
          ++corner;
        });
        return static_cast<char>(any);
      });
  if (std::none_of(colored.begin(), colored.end(), [](char any) { return any != 0; })) mesh.colors.clear();
  return mesh;
}

}  // namespace fusebench::meshing
