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

// Change of the distance from one voxel to the next at the middle of three; the outer ones may be unobserved
// (NaN).
double slope(float before_m, float centre_m, float after_m) {
  const bool has_before = !std::isnan(before_m);
  const bool has_after = !std::isnan(after_m);
  const double difference_m = static_cast<double>(has_after ? after_m : centre_m) -
                              static_cast<double>(has_before ? before_m : centre_m);
  return has_before && has_after ? 0.5 * difference_m : difference_m;
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
    const float* base_m = block_m(found) + offset_in_block(cell.base);
    constexpr std::size_t kRow = kBlockSide;
    constexpr std::size_t kSlice = kBlockSide * kBlockSide;
    cell.corner_m = {base_m[0],      base_m[1],          base_m[kRow],          base_m[kRow + 1],
                     base_m[kSlice], base_m[kSlice + 1], base_m[kSlice + kRow], base_m[kSlice + kRow + 1]};
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

Vector3d TsdfSampler::gradient(const VoxelIndex& index) {
  const float centre_m = distance_m(index);
  Vector3d gradient = Vector3d::Zero();
  for (Eigen::Index axis = 0; axis < 3 && !std::isnan(centre_m); ++axis) {
    const VoxelIndex unit = VoxelIndex::Unit(axis);
    gradient[axis] = slope(distance_m(index - unit), centre_m, distance_m(index + unit)) * per_voxel_;
  }
  return gradient;
}

Vector3d TsdfSampler::gradient_at(const Vector3d& point_world) {
  Cell cell;
  Vector3d sum = Vector3d::Zero();
  if (!find_cell(point_world, cell)) return sum;
  const std::array<double, 8> weights = trilinear_weights(cell.fraction);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const VoxelIndex unit = VoxelIndex::Unit(axis);
    const std::size_t bit = std::size_t{1} << axis;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if ((corner & bit) != 0) continue;
      // Four voxels in a row along the axis: the outer two may be unobserved, the inner two are corners.
      const VoxelIndex at = corner_of(cell.base, static_cast<int>(corner));
      const float low_m = cell.corner_m[corner];
      const float high_m = cell.corner_m[corner | bit];
      sum[axis] += weights[corner] * slope(distance_m(at - unit), low_m, high_m) +
                   weights[corner | bit] * slope(low_m, high_m, distance_m(at + 2 * unit));
    }
  }
  return sum * per_voxel_;
}

}  // namespace fusebench
