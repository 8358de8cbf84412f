#include "core/band_blocks.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace fusebench {
namespace {

constexpr std::size_t kRowsPerChunk = 16;

// The set of blocks in the order in which they were first met.
class OrderedBlocks {
 public:
  void add(const BlockIndex& index) {
    if (index == last_) return;  // most rays run through the blocks of the ray before
    last_ = index;
    if (table_.insert(index)) blocks_.push_back(index);
  }
  [[nodiscard]] std::vector<BlockIndex> take() { return std::move(blocks_); }

 private:
  BlockTable table_;
  std::vector<BlockIndex> blocks_;
  BlockIndex last_ = BlockIndex::Constant(std::numeric_limits<int>::max());
};

// Adds the blocks on the segment from begin to end (in units of blocks): the traversal of Amanatides & Woo
// 1987. The number of steps is known beforehand, so rounding can at worst pick a neighbour at a corner, never
// run away.
void add_segment(const Vector3d& begin, const Vector3d& end, OrderedBlocks& blocks) {
  std::array<int, 3> at{};
  std::array<int, 3> step{};
  std::array<double, 3> next{};   // fraction of the segment at which each axis is crossed next
  std::array<double, 3> delta{};  // fraction between two crossings
  int steps = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const double floor_begin = std::floor(begin[k]);
    at[axis] = static_cast<int>(floor_begin);
    const int crossings = static_cast<int>(std::floor(end[k])) - at[axis];
    steps += std::abs(crossings);
    step[axis] = crossings > 0 ? 1 : -1;
    next[axis] = delta[axis] = std::numeric_limits<double>::infinity();
    if (crossings != 0) {
      const double length = end[k] - begin[k];
      delta[axis] = std::abs(1.0 / length);
      next[axis] = (crossings > 0 ? floor_begin + 1.0 - begin[k] : begin[k] - floor_begin) * delta[axis];
    }
  }
  blocks.add({at[0], at[1], at[2]});
  for (; steps > 0; --steps) {
    const std::size_t axis = next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : (next[1] <= next[2] ? 1 : 2);
    at[axis] += step[axis];
    next[axis] += delta[axis];
    blocks.add({at[0], at[1], at[2]});
  }
}

}  // namespace

std::vector<BlockIndex> band_blocks(const DepthImage& depth_m, const PinholeCamera& camera,
                                    const SE3& T_world_camera, double block_m, const DepthConfig& depth,
                                    const std::function<double(double)>& truncation_m,
                                    const Workers& workers) {
  const Matrix3d axes = T_world_camera.rotation_matrix() / block_m;
  const Vector3d origin = T_world_camera.translation / block_m;
  const auto blocks_of_rows = [&](std::size_t begin, std::size_t end) {
    OrderedBlocks blocks;
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < depth_m.width; ++x) {
        const double z_m = depth_m(x, y);
        if (!(z_m >= depth.min_m && z_m <= depth.max_m)) continue;
        const double band_m = truncation_m(z_m);
        const Vector3d ray = axes * camera.back_project(x, y, 1.0);
        add_segment(origin + std::max(0.0, z_m - band_m) * ray, origin + (z_m + band_m) * ray, blocks);
      }
    }
    return blocks.take();
  };
  OrderedBlocks merged;
  const auto chunks = workers.map_chunks<std::vector<BlockIndex>>(static_cast<std::size_t>(depth_m.height),
                                                                  kRowsPerChunk, blocks_of_rows);
  for (const std::vector<BlockIndex>& chunk : chunks) {
    for (const BlockIndex& index : chunk) merged.add(index);
  }
  return merged.take();
}

}  // namespace fusebench
