#include "core/tsdf_sampler.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench {
namespace {

// Weights of the eight corners of a cell at a position in [0, 1)^3; bit 0 of the number: x, bit 1: y, bit 2:
// z.
std::array<double, 8> trilinear_weights(const Vector3d& f) {
  const Vector3d g = Vector3d::Ones() - f;
  const std::array<double, 4> xy = {g.x() * g.y(), f.x() * g.y(), g.x() * f.y(), f.x() * f.y()};
  return {xy[0] * g.z(), xy[1] * g.z(), xy[2] * g.z(), xy[3] * g.z(),
          xy[0] * f.z(), xy[1] * f.z(), xy[2] * f.z(), xy[3] * f.z()};
}

VoxelIndex corner_of(const VoxelIndex& base, int corner) {
  return base + VoxelIndex(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
}

}  // namespace

bool TsdfSampler::find_cell(const Vector3d& point_world, Cell& cell) {
  if (!(point_world.cwiseAbs().maxCoeff() < reach_m_)) return false;
  const Vector3d lattice = point_world * per_voxel_;
  const Vector3d floored(std::floor(lattice.x()), std::floor(lattice.y()), std::floor(lattice.z()));
  cell.base = floored.cast<int>();
  cell.fraction = lattice - floored;

  const VoxelIndex local(cell.base.x() & 7, cell.base.y() & 7, cell.base.z() & 7);
  if (local.maxCoeff() < kBlockSide - 1) {  // the whole cell lies in one block: two of three cells
    const int found = slot(block_of(cell.base));
    if (found < 0) return false;
    const Half* base_m = block_m(found) + offset_in_block(cell.base);
    constexpr std::size_t kRow = kBlockSide;
    constexpr std::size_t kSlice = kBlockSide * kBlockSide;
    constexpr std::array<std::size_t, 8> kCorner = {0,      1,          kRow,          kRow + 1,
                                                    kSlice, kSlice + 1, kSlice + kRow, kSlice + kRow + 1};
    for (std::size_t corner = 0; corner < 8; ++corner) {
      cell.corner_m[corner] = static_cast<float>(base_m[kCorner[corner]]);
    }
  } else {
    for (int corner = 0; corner < 8; ++corner) {
      cell.corner_m[static_cast<std::size_t>(corner)] = distance_m(corner_of(cell.base, corner));
    }
  }
  return std::none_of(cell.corner_m.begin(), cell.corner_m.end(),
                      [](float corner_m) { return std::isnan(corner_m); });
}

TsdfSample TsdfSampler::sample(const Vector3d& point_world) {
  Cell cell;
  if (!find_cell(point_world, cell)) return {};
  const std::array<double, 8> weights = trilinear_weights(cell.fraction);
  double distance_m = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    distance_m += weights[corner] * static_cast<double>(cell.corner_m[corner]);
  }
  return {true, distance_m};
}

}  // namespace fusebench
