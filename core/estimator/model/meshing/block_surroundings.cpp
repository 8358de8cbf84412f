#include "core/estimator/model/meshing/block_surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fusebench::meshing {

namespace {

static_assert(tsdf::kBlockSide == simd::kLanes, "a row of a block is one vector");

// Change of the distance per voxel at the middle of three voxels; the outer ones may be unobserved (NaN).
double slope(float before_m, float centre_m, float after_m) {
  const bool has_before = !std::isnan(before_m);
  const bool has_after = !std::isnan(after_m);
  const double difference_m = static_cast<double>(has_after ? after_m : centre_m) -
                              static_cast<double>(has_before ? before_m : centre_m);
  return has_before && has_after ? 0.5 * difference_m : difference_m;
}

}  // namespace

void BlockSurroundings::load(const tsdf::BlockIndex& index) {
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x)
        around_[neighbour(x, y, z)] = slots_.find(index + tsdf::BlockIndex(x, y, z));
    }
  }
  for (int z = -kBefore; z < kSide - kBefore; ++z) {
    for (int y = -kBefore; y < kSide - kBefore; ++y) load_row(y, z);
  }
}

// Copies a row from the previous, the own and the next block. For a missing block (slot -1) all voxels are
// unobserved.
void BlockSurroundings::load_row(int y, int z) {
  const std::size_t row = tsdf::offset_in_block({0, y, z});
  const auto block_row_m = [&](int x) {
    const std::ptrdiff_t slot = around_[neighbour(x, y >> 3, z >> 3)];
    return volume_.distances_m() + slot * tsdf::kBlockVoxels + row;
  };
  float* const to = &distances_m_[place({-kBefore, y, z})];
  to[0] = static_cast<float>(block_row_m(-1)[tsdf::kBlockSide - 1]);
  simd::store(simd::load(block_row_m(0)), to + 1);
  to[tsdf::kBlockSide + 1] = static_cast<float>(block_row_m(1)[0]);
  to[tsdf::kBlockSide + 2] = static_cast<float>(block_row_m(1)[1]);
}

std::uint32_t BlockSurroundings::color(const tsdf::VoxelIndex& local) const {
  const int slot = around_[neighbour(local.x() >> 3, local.y() >> 3, local.z() >> 3)];
  if (slot < 0) return 0;
  return volume_.colors()[static_cast<std::size_t>(slot) * tsdf::kBlockVoxels + tsdf::offset_in_block(local)];
}

Vector3d BlockSurroundings::gradient(const tsdf::VoxelIndex& local) const {
  const float* const centre_m = &distances_m_[place(local)];
  constexpr std::array<std::ptrdiff_t, 3> kStride = {1, kSide, kSide * kSide};
  Vector3d gradient;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t step = kStride[axis];
    gradient[static_cast<Eigen::Index>(axis)] = slope(centre_m[-step], centre_m[0], centre_m[step]);
  }
  return gradient;
}

}  // namespace fusebench::meshing
