// Trilinear interpolation of a field at eight positions. Coordinates are in voxels. A cube provides pair_m(x,
// y, z): eight distances (metres) at a voxel relative to the cube's first, and at the next one along x; NaN
// if unobserved.
#pragma once

#include <array>
#include <limits>

#include "core/base/simd/half_lanes.hpp"
#include "core/base/simd/lane_points.hpp"

namespace fusebench::tsdf {

/// Marks unobserved values.
[[nodiscard]] inline simd::Float8 not_a_number() {
  return simd::all_lanes(std::numeric_limits<float>::quiet_NaN());
}

/// Eight integer lattice positions.
struct LatticePoints {
  simd::Int8 x;
  simd::Int8 y;
  simd::Int8 z;
};

/// The cells of eight points and the weights of their eight corners; bits of a corner's number: 0: x, 1: y,
/// 2: z.
struct TrilinearCell {
  explicit TrilinearCell(const simd::Points& at)
      : base{simd::floor_to_int(at.x), simd::floor_to_int(at.y), simd::floor_to_int(at.z)} {
    const simd::Points f = {at.x - simd::to_float(base.x), at.y - simd::to_float(base.y),
                            at.z - simd::to_float(base.z)};
    const simd::Points g = {1.0F - f.x, 1.0F - f.y, 1.0F - f.z};
    const std::array<simd::Float8, 4> xy = {g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y};
    weights = {xy[0] * g.z, xy[1] * g.z, xy[2] * g.z, xy[3] * g.z,
               xy[0] * f.z, xy[1] * f.z, xy[2] * f.z, xy[3] * f.z};
  }

  LatticePoints base;
  std::array<simd::Float8, 8> weights;
};

/// Interpolated distance; `cube` begins at the base of the cell. NaN if one of the eight corners is
/// unobserved.
template <class Cube>
[[nodiscard]] simd::Float8 interpolated_m(const TrilinearCell& cell, const Cube& cube) {
  simd::Float8 sum_m{};
  for (std::size_t corner = 0; corner < 8; corner += 2) {
    const simd::Pairs pair_m =
        cube.pair_m(0, static_cast<int>(corner >> 1) & 1, static_cast<int>(corner >> 2));
    sum_m = simd::multiply_add(cell.weights[corner], pair_m.first, sum_m);
    sum_m = simd::multiply_add(cell.weights[corner + 1], pair_m.second, sum_m);
  }
  return sum_m;
}

/// Change of the distance per voxel at the middle of three voxels; the outer ones may be unobserved.
[[nodiscard]] inline simd::Float8 slope(simd::Float8 before_m, simd::Float8 centre_m, simd::Float8 after_m) {
  const simd::Int8 has_before = before_m == before_m;
  const simd::Int8 has_after = after_m == after_m;
  const simd::Float8 difference_m = (has_after ? after_m : centre_m) - (has_before ? before_m : centre_m);
  return has_before & has_after ? 0.5F * difference_m : difference_m;
}

/// Distances at the eight corners of a cell and at their neighbours along the axes.
struct CellNeighbourhood {
  /// cube: begins one voxel before the base of the cell on each axis and has a side of four.
  template <class Cube>
  explicit CellNeighbourhood(const Cube& cube) {
    const auto copy_pair = [&](int x, int y, int z) {
      const simd::Pairs pair_m = cube.pair_m(x, y, z);
      distances_m[place(x, y, z)] = pair_m.first;
      distances_m[place(x + 1, y, z)] = pair_m.second;
    };
    for (int a = 1; a < 3; ++a) {
      for (int b = 1; b < 3; ++b) {
        copy_pair(0, a, b);
        copy_pair(2, a, b);
      }
      for (const int outer : {0, 3}) {
        copy_pair(1, outer, a);
        copy_pair(1, a, outer);
      }
    }
  }

  static constexpr std::size_t place(int x, int y, int z) {
    return static_cast<std::size_t>(x + 4 * y + 16 * z);
  }

  std::array<simd::Float8, 64> distances_m;  // the corners of the cube are not set
};

/// Gradient (metres per voxel): trilinear interpolation of the gradients at the eight corners (central
/// differences, one-sided next to unobserved voxels). `cube` begins one voxel before the base of the cell on
/// each axis and has a side of four. NaN if one of the eight corners is unobserved.
template <class Cube>
[[nodiscard]] simd::Points interpolated_gradient(const TrilinearCell& cell, const Cube& cube) {
  const CellNeighbourhood around(cube);
  // Four voxels along the axis: the outer two may be unobserved; an unobserved inner one (a corner) makes the
  // sum NaN.
  const auto along = [&](std::size_t axis) {
    const std::size_t bit = std::size_t{1} << axis;
    const std::size_t step = std::size_t{1} << (2 * axis);
    simd::Float8 sum{};
    for (std::size_t c = 0; c < 8; ++c) {
      if ((c & bit) != 0) continue;
      const simd::Float8* const low = &around.distances_m[CellNeighbourhood::place(
          1 + static_cast<int>(c & 1), 1 + static_cast<int>((c >> 1) & 1), 1 + static_cast<int>(c >> 2))];
      sum = simd::multiply_add(cell.weights[c], slope(*(low - step), *low, *(low + step)), sum);
      sum = simd::multiply_add(cell.weights[c | bit], slope(*low, *(low + step), *(low + 2 * step)), sum);
    }
    return sum;
  };
  return {along(0), along(1), along(2)};
}

}  // namespace fusebench::tsdf
