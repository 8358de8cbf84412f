// Interpolation between the voxels of a field at eight places at once. Coordinates are in voxels; a cube is
// anything with distance_m(x, y, z): eight distances (metres) at a voxel counted from the cube's first, NaN
// where a voxel was not observed.
#pragma once

#include <array>
#include <limits>

#include "core/lane_points.hpp"

namespace fusebench {

/// In place of what is not known.
[[nodiscard]] inline Float8 not_a_number() { return all_lanes(std::numeric_limits<float>::quiet_NaN()); }

/// Eight integer places of a lattice.
struct LatticePoints {
  Int8 x;
  Int8 y;
  Int8 z;
};

/// The cells that points lie in, and the weights of their eight corners; bit 0 of a corner's number: x, bit
/// 1: y, bit 2: z.
struct TrilinearCell {
  explicit TrilinearCell(const Points& at)
      : base{floor_to_int(at.x), floor_to_int(at.y), floor_to_int(at.z)} {
    const Points f = {at.x - to_float(base.x), at.y - to_float(base.y), at.z - to_float(base.z)};
    const Points g = {1.0F - f.x, 1.0F - f.y, 1.0F - f.z};
    const std::array<Float8, 4> xy = {g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y};
    weights = {xy[0] * g.z, xy[1] * g.z, xy[2] * g.z, xy[3] * g.z,
               xy[0] * f.z, xy[1] * f.z, xy[2] * f.z, xy[3] * f.z};
  }

  LatticePoints base;
  std::array<Float8, 8> weights;
};

/// The distance; `cube` begins at the cell's base. NaN where one of the eight corners was not observed.
template <class Cube>
[[nodiscard]] Float8 interpolated_m(const TrilinearCell& cell, const Cube& cube) {
  Float8 sum_m{};
  for (int corner = 0; corner < 8; ++corner) {
    sum_m += cell.weights[static_cast<std::size_t>(corner)] *
             cube.distance_m(corner & 1, (corner >> 1) & 1, corner >> 2);
  }
  return sum_m;
}

/// Change of the distance from one voxel to the next at the middle of three; the outer ones may be
/// unobserved.
[[nodiscard]] inline Float8 slope(Float8 before_m, Float8 centre_m, Float8 after_m) {
  const Int8 has_before = before_m == before_m;
  const Int8 has_after = after_m == after_m;
  const Float8 difference_m = (has_after ? after_m : centre_m) - (has_before ? before_m : centre_m);
  return has_before & has_after ? 0.5F * difference_m : difference_m;
}

/// The gradient (metres per voxel): that at the eight corners by central differences, one-sided next to
/// unobserved voxels, interpolated; `cube` begins one voxel before the cell's base on each axis and has four
/// a side. NaN where one of the eight corners was not observed.
template <class Cube>
[[nodiscard]] Points interpolated_gradient(const TrilinearCell& cell, const Cube& cube) {
  std::array<Float8, 8> corner_m;
  for (int c = 0; c < 8; ++c) {
    corner_m[static_cast<std::size_t>(c)] = cube.distance_m(1 + (c & 1), 1 + ((c >> 1) & 1), 1 + (c >> 2));
  }
  // Four voxels in a row along the axis: the outer two may be unobserved, the inner two are corners, of which
  // an unobserved one makes the sum NaN.
  const auto along = [&](int axis) {
    Float8 sum{};
    for (int c = 0; c < 8; ++c) {
      const int bit = 1 << axis;
      if ((c & bit) != 0) continue;
      const auto low = static_cast<std::size_t>(c);
      const auto high = static_cast<std::size_t>(c | bit);
      std::array<int, 3> before = {1 + (c & 1), 1 + ((c >> 1) & 1), 1 + (c >> 2)};
      std::array<int, 3> after = before;
      before[static_cast<std::size_t>(axis)] = 0;
      after[static_cast<std::size_t>(axis)] = 3;
      sum += cell.weights[low] *
                 slope(cube.distance_m(before[0], before[1], before[2]), corner_m[low], corner_m[high]) +
             cell.weights[high] *
                 slope(corner_m[low], corner_m[high], cube.distance_m(after[0], after[1], after[2]));
    }
    return sum;
  };
  return {along(0), along(1), along(2)};
}

}  // namespace fusebench
