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
  OrderedBlocks() { recent_.fill(BlockIndex::Constant(std::numeric_limits<int>::max())); }

  void add(const BlockIndex& index) {
    // Most rays run through the blocks of the rays before.
    BlockIndex& recent =
        recent_[static_cast<std::size_t>((index.x() & 3) | (index.y() & 3) << 2 | (index.z() & 3) << 4)];
    if (index == recent) return;
    recent = index;
    if (table_.insert(index)) blocks_.push_back(index);
  }
  [[nodiscard]] std::vector<BlockIndex> take() { return std::move(blocks_); }

 private:
  BlockTable table_;
  std::vector<BlockIndex> blocks_;
  std::array<BlockIndex, 64> recent_;
};

// Both sides are computed before the choice, so that the compiler makes vector instructions of a loop: it may
// not compute what the program would skip.
template <class T>
T select(bool condition, T yes, T no) {
  return condition ? yes : no;
}

// What the segments of a row of pixels do along one axis of the lattice, in units of blocks.
struct AxisSegments {
  explicit AxisSegments(std::size_t width)
      : ray_by_u(width), begin(width), crossings(width), next(width), delta(width) {}

  // From origin + near * ray to origin + far * ray, ray = ray_by_u + ray_by_v.
  void set(double origin, double ray_by_v, const std::vector<double>& near, const std::vector<double>& far) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const std::size_t count = begin.size();
    const double* const ray_by_column = ray_by_u.data();
    const double* const near_m = near.data();
    const double* const far_m = far.data();
    int* const begins = begin.data();
    int* const crosses = crossings.data();
    double* const nexts = next.data();
    double* const deltas = delta.data();
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
      const double ray = ray_by_column[i] + ray_by_v;
      const double from = origin + near_m[i] * ray;
      const double to = origin + far_m[i] * ray;
      const double floor_from = std::floor(from);
      const double floor_to = std::floor(to);
      const double between = std::abs(1.0 / (to - from));
      const double rest = select(floor_to > floor_from, floor_from + 1.0 - from, from - floor_from);
      begins[i] = static_cast<int>(floor_from);
      crosses[i] = static_cast<int>(floor_to) - static_cast<int>(floor_from);
      deltas[i] = select(floor_to == floor_from, kNever, between);
      nexts[i] = select(floor_to == floor_from, kNever, rest * between);
    }
  }

  std::vector<double> ray_by_u;  // part of the ray that depends on the column
  std::vector<int> begin;        // block in which the segment begins
  std::vector<int> crossings;    // faces that it crosses, negative if downwards
  std::vector<double> next;      // fraction of the segment at which it crosses the first of them
  std::vector<double> delta;     // fraction between two crossings
};

// The rays of a row of pixels, cut to the band around their measurements.
class RowSegments {
 public:
  RowSegments(const PinholeCamera& camera, const SE3& T_world_camera, double block_m, const TsdfConfig& tsdf,
              const DepthConfig& depth)
      : camera_(camera),
        tsdf_(tsdf),
        depth_(depth),
        rays_(T_world_camera.rotation_matrix() / block_m),
        origin_(T_world_camera.translation / block_m),
        near_m_(static_cast<std::size_t>(camera.width_px)),
        far_m_(near_m_),
        axes_{AxisSegments(near_m_.size()), AxisSegments(near_m_.size()), AxisSegments(near_m_.size())} {
    for (int x = 0; x < camera.width_px; ++x) {
      const Vector3d by_u = rays_.col(0) * camera.back_project(x, 0, 1.0).x();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        axes_[axis].ray_by_u[static_cast<std::size_t>(x)] = by_u[static_cast<Eigen::Index>(axis)];
      }
    }
  }

  void set_row(const DepthImage& depth_m, int y) {
    cut(&depth_m.data[depth_m.index(0, y)]);
    const Vector3d by_v = rays_.col(1) * camera_.back_project(0, y, 1.0).y() + rays_.col(2);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      axes_[axis].set(origin_[k], by_v[k], near_m_, far_m_);
    }
  }

  // Adds the blocks on the segment of a column: the traversal of Amanatides & Woo 1987. The number of steps
  // is known beforehand, so rounding can at worst pick a neighbour at a corner, never run away.
  void add_blocks(std::size_t x, OrderedBlocks& blocks) {
    if (far_m_[x] == 0.0) return;  // not measured
    const std::array<int, 3> crossings = {axes_[0].crossings[x], axes_[1].crossings[x],
                                          axes_[2].crossings[x]};
    std::array<double, 3> next = {axes_[0].next[x], axes_[1].next[x], axes_[2].next[x]};
    BlockIndex at(axes_[0].begin[x], axes_[1].begin[x], axes_[2].begin[x]);
    // Segments that cross at most one face of an axis run through the same blocks if they begin in the same
    // one and cross the same faces in the same order: mostly those of neighbouring pixels.
    const int order =
        (next[0] <= next[1] ? 1 : 0) | (next[0] <= next[2] ? 2 : 0) | (next[1] <= next[2] ? 4 : 0);
    const Path path = {at, crossings, order};
    const bool one_face =
        (std::abs(crossings[0]) <= 1) & (std::abs(crossings[1]) <= 1) & (std::abs(crossings[2]) <= 1);
    if (one_face && path.same_as(last_path_)) return;
    last_path_ = path;

    blocks.add(at);
    for (int steps = std::abs(crossings[0]) + std::abs(crossings[1]) + std::abs(crossings[2]); steps > 0;
         --steps) {
      const std::size_t axis =
          next[0] <= next[1] ? (next[0] <= next[2] ? 0 : 2) : (next[1] <= next[2] ? 1 : 2);
      at[static_cast<Eigen::Index>(axis)] += crossings[axis] > 0 ? 1 : -1;
      next[axis] += axes_[axis].delta[x];
      blocks.add(at);
    }
  }

 private:
  // Which way a segment takes through the blocks, if it crosses at most one face of each axis.
  struct Path {
    BlockIndex begin = BlockIndex::Zero();
    std::array<int, 3> crossings{};
    int order = -1;

    // Without branches: it mostly holds, and all of it is at hand.
    [[nodiscard]] bool same_as(const Path& other) const {
      return ((begin.x() ^ other.begin.x()) | (begin.y() ^ other.begin.y()) | (begin.z() ^ other.begin.z()) |
              (crossings[0] ^ other.crossings[0]) | (crossings[1] ^ other.crossings[1]) |
              (crossings[2] ^ other.crossings[2]) | (order ^ other.order)) == 0;
    }
  };

  // Where the bands begin and end; both 0 where nothing was measured.
  void cut(const float* measured_m) {
    const std::size_t count = near_m_.size();
    double* const near_m = near_m_.data();
    double* const far_m = far_m_.data();
    const TsdfConfig tsdf = tsdf_;
    const DepthConfig depth = depth_;
#pragma GCC ivdep
    for (std::size_t i = 0; i < count; ++i) {
      const auto z_m = static_cast<double>(measured_m[i]);
      const double band_m = half_band_m(z_m, tsdf, depth);
      const bool measured = (z_m >= depth.min_m) & (z_m <= depth.max_m);
      near_m[i] = select(measured, std::max(0.0, z_m - band_m), 0.0);
      far_m[i] = select(measured, z_m + band_m, 0.0);
    }
  }

  const PinholeCamera& camera_;
  const TsdfConfig& tsdf_;
  const DepthConfig& depth_;
  Matrix3d rays_;  // columns: the ray by u, by v (on the plane z = 1) and along
                   // the optical axis
  Vector3d origin_;
  std::vector<double> near_m_;  // z-depth
  std::vector<double> far_m_;
  std::array<AxisSegments, 3> axes_;
  Path last_path_;
};

}  // namespace

std::vector<BlockIndex> band_blocks(const DepthImage& depth_m, const PinholeCamera& camera,
                                    const SE3& T_world_camera, double block_m, const TsdfConfig& tsdf,
                                    const DepthConfig& depth, const Workers& workers) {
  const auto blocks_of_rows = [&](std::size_t begin, std::size_t end) {
    OrderedBlocks blocks;
    RowSegments segments(camera, T_world_camera, block_m, tsdf, depth);
    for (std::size_t y = begin; y < end; ++y) {
      segments.set_row(depth_m, static_cast<int>(y));
      for (std::size_t x = 0; x < static_cast<std::size_t>(depth_m.width); ++x)
        segments.add_blocks(x, blocks);
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
