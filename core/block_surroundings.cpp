#include "core/block_surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fusebench {

namespace {

static_assert(kBlockSide == kLanes, "a row of a block is one vector");

/// Voxels that a neighbour at an offset of -1, 0 or 1 adds along an axis, by their places in the block and in
/// the neighbour.
struct Overlap {
  explicit Overlap(int offset)
      : first(offset < 0    ? -1
              : offset == 0 ? 0
                            : kBlockSide),
        count(offset < 0    ? 1
              : offset == 0 ? kBlockSide
                            : 2),
        source(offset < 0 ? kBlockSide - 1 : 0) {}
  int first;
  int count;
  int source;
};

// Change of the distance from one voxel to the next at the middle of three; the outer ones may be unobserved
// (NaN).
double slope(float before_m, float centre_m, float after_m) {
  const bool has_before = !std::isnan(before_m);
  const bool has_after = !std::isnan(after_m);
  const double difference_m = static_cast<double>(has_after ? after_m : centre_m) -
                              static_cast<double>(has_before ? before_m : centre_m);
  return has_before && has_after ? 0.5 * difference_m : difference_m;
}

}  // namespace

void BlockSurroundings::load(const TsdfVolume& volume, const BlockIndex& index) {
  distances_m_.fill(std::numeric_limits<float>::quiet_NaN());
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) load_neighbour(volume, index, {x, y, z});
    }
  }
}

void BlockSurroundings::load_neighbour(const TsdfVolume& volume, const BlockIndex& index,
                                       const BlockIndex& offset) {
  const int slot = volume.find_block(index + offset);
  if (slot < 0) return;
  const Half* const block_m = volume.distances_m() + static_cast<std::size_t>(slot) * kBlockVoxels;
  const Overlap x(offset.x()), y(offset.y()), z(offset.z());
  for (int k = 0; k < z.count; ++k) {
    for (int j = 0; j < y.count; ++j) {
      const std::size_t from = offset_in_block({x.source, y.source + j, z.source + k});
      float* const to = &distances_m_[place({x.first, y.first + j, z.first + k})];
      if (x.count == kBlockSide) {
        store(fusebench::load(block_m + from), to);
      } else {
        std::transform(block_m + from, block_m + from + x.count, to,
                       [](Half distance_m) { return static_cast<float>(distance_m); });
      }
    }
  }
}

Vector3d BlockSurroundings::gradient(const VoxelIndex& local) const {
  const float* const centre_m = &distances_m_[place(local)];
  constexpr std::array<std::ptrdiff_t, 3> kStride = {1, kSide, kSide * kSide};
  Vector3d gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t step = kStride[axis];
    gradient[static_cast<Eigen::Index>(axis)] = slope(centre_m[-step], centre_m[0], centre_m[step]);
  }
  return gradient;
}

}  // namespace fusebench
