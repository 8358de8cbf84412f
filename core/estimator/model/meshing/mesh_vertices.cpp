#include "core/estimator/model/meshing/mesh_vertices.hpp"

#include "core/base/bits.hpp"
#include "core/estimator/model/meshing/block_surroundings.hpp"

namespace fusebench::meshing {
namespace {

// Interpolates colours of two voxels (BlockVoxels). If one has none, takes that of the other. False if
// neither has one.
bool blend(std::uint32_t low, std::uint32_t high, float share, Rgb& color) {
  constexpr int kCountByte = 24;
  const std::uint32_t from = low >> kCountByte != 0 ? low : high;
  const std::uint32_t to = high >> kCountByte != 0 ? high : low;
  if (from >> kCountByte == 0) return false;
  for (std::size_t channel = 0; channel < color.size(); ++channel) {
    const auto level = [&](std::uint32_t bytes) { return static_cast<float>(bytes >> (8 * channel) & 0xFF); };
    color[channel] = static_cast<std::uint8_t>(level(from) + share * (level(to) - level(from)) + 0.5F);
  }
  return true;
}

class VertexWriter {
 public:
  VertexWriter(const tsdf::TsdfVolume& volume, Mesh& mesh)
      : voxel_m_(volume.voxel_m()), surroundings_(volume), mesh_(mesh) {}

  // Writes the vertices of one block. True if any has a colour.
  bool write(const tsdf::BlockIndex& block, const BlockVertices& vertices) {
    if (!vertices.any()) return false;
    surroundings_.load(block);
    bool colored = false;
    for (std::size_t word = 0; word < BlockVertices::kWords; ++word) {
      std::size_t vertex = vertices.before[word];
      for_each_bit(vertices.used[word], [&](std::size_t bit) {
        const int edge = static_cast<int>(word * 64 + bit);
        const int offset = edge / 3;
        const tsdf::VoxelIndex local(offset & 7, (offset >> 3) & 7, offset >> 6);
        colored |= write_vertex(block, local, edge % 3, vertex++);
      });
    }
    return colored;
  }

 private:
  // Writes the vertex on the edge from a voxel along an axis. True if it has a colour.
  bool write_vertex(const tsdf::BlockIndex& block, const tsdf::VoxelIndex& local, Eigen::Index axis,
                    std::size_t vertex) {
    const tsdf::VoxelIndex index = block * tsdf::kBlockSide + local;
    const tsdf::VoxelIndex unit = tsdf::VoxelIndex::Unit(axis);
    const double low_m = surroundings_.distance_m(local);
    const double share = low_m / (low_m - static_cast<double>(surroundings_.distance_m(local + unit)));
    const Vector3d position = (index.cast<double>() + share * Vector3d::Unit(axis)) * voxel_m_;
    Vector3d normal =
        (1.0 - share) * surroundings_.gradient(local) + share * surroundings_.gradient(local + unit);
    if (!(normal.norm() > 0.0)) normal = (low_m < 0.0 ? 1.0 : -1.0) * Vector3d::Unit(axis);
    mesh_.vertices[vertex] = position.cast<float>();
    mesh_.normals[vertex] = normal.normalized().cast<float>();
    return blend(surroundings_.color(local), surroundings_.color(local + unit), static_cast<float>(share),
                 mesh_.colors[vertex]);
  }

  double voxel_m_;
  BlockSurroundings surroundings_;
  Mesh& mesh_;
};

}  // namespace

bool write_vertices(const tsdf::TsdfVolume& volume, std::span<const std::size_t> slots,
                    std::span<const BlockVertices> vertices, Mesh& mesh) {
  VertexWriter writer(volume, mesh);
  bool colored = false;
  for (std::size_t i = 0; i < slots.size(); ++i)
    colored |= writer.write(volume.block_indices()[slots[i]], vertices[i]);
  return colored;
}

}  // namespace fusebench::meshing
