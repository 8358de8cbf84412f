#include "core/tsdf_lanes.hpp"

#include <cmath>
#include <limits>

namespace fusebench {

namespace {

constexpr int kRegionVoxels = kRegionSide * kBlockSide;
/// A window of more regions than this (16 MB) takes longer to make than it saves.
constexpr double kMostWindowRegions = 1 << 22;

/// Weights of the eight corners of a cell; bit 0 of the number: x, bit 1: y, bit 2: z.
std::array<Float8, 8> trilinear_weights(const Points& f) {
  const Points g = {1.0F - f.x, 1.0F - f.y, 1.0F - f.z};
  const std::array<Float8, 4> xy = {g.x * g.y, f.x * g.y, g.x * f.y, f.x * f.y};
  return {xy[0] * g.z, xy[1] * g.z, xy[2] * g.z, xy[3] * g.z,
          xy[0] * f.z, xy[1] * f.z, xy[2] * f.z, xy[3] * f.z};
}

/// Change of the distance from one voxel to the next at the middle of three; the outer ones may be
/// unobserved.
Float8 slope(Float8 before_m, Float8 centre_m, Float8 after_m) {
  const Int8 has_before = before_m == before_m;
  const Int8 has_after = after_m == after_m;
  const Float8 difference_m = (has_after ? after_m : centre_m) - (has_before ? before_m : centre_m);
  return has_before & has_after ? 0.5F * difference_m : difference_m;
}

}  // namespace

/// The blocks of a few voxels in a row on each axis, from `first` on: at most two an axis.
struct TsdfLanes::Neighbourhood {
  Neighbourhood(const TsdfLanes& field, const LatticePoints& first, int count) {
    const LatticePoints low = {first.x >> 3, first.y >> 3, first.z >> 3};
    const LatticePoints high = {(first.x + (count - 1)) >> 3, (first.y + (count - 1)) >> 3,
                                (first.z + (count - 1)) >> 3};
    low_ = low;
    crossed_ = {any(low.x != high.x), any(low.y != high.y), any(low.z != high.z)};
    for (std::size_t n = 0; n < 8; ++n) {
      // A second block that no lane reaches is not looked for.
      const std::size_t unreached =
          (n & 1 && !crossed_[0] ? 1 : 0) | (n & 2 && !crossed_[1] ? 2 : 0) | (n & 4 && !crossed_[2] ? 4 : 0);
      slots_[n] = unreached != 0
                      ? slots_[n & ~unreached]
                      : field.slots({n & 1 ? high.x : low.x, n & 2 ? high.y : low.y, n & 4 ? high.z : low.z});
    }
  }

  /// The slots of the voxels, -1 = none.
  [[nodiscard]] Int8 slot(const LatticePoints& voxel) const {
    const auto across = [&](std::size_t n) {
      return crossed_[0] ? ((voxel.x >> 3) != low_.x ? slots_[n | 1] : slots_[n]) : slots_[n];
    };
    const auto down = [&](std::size_t n) {
      return crossed_[1] ? ((voxel.y >> 3) != low_.y ? across(n | 2) : across(n)) : across(n);
    };
    return crossed_[2] ? ((voxel.z >> 3) != low_.z ? down(4) : down(0)) : down(0);
  }

  LatticePoints low_;
  std::array<bool, 3> crossed_;
  std::array<Int8, 8> slots_;
};

TsdfLanes::TsdfLanes(const TsdfVolume& volume, const Vector3d& centre_world, double reach_m)
    : volume_(volume),
      origin_region_((centre_world / (kRegionVoxels * volume.voxel_m())).array().floor().cast<int>()),
      origin_voxel_(origin_region_.cast<double>() * kRegionVoxels),
      reach_(static_cast<int>(std::ceil(reach_m / (kRegionVoxels * volume.voxel_m()))) + 1) {
  const double side = 2.0 * reach_ + 1.0;
  if (side * side * side > kMostWindowRegions) return;
  const auto regions_a_side = static_cast<std::size_t>(side);
  window_.assign(regions_a_side * regions_a_side * regions_a_side, -1);
  const std::vector<Eigen::Vector3i>& regions = volume.region_indices();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Eigen::Vector3i from_corner = regions[i] - origin_region_ + Eigen::Vector3i::Constant(reach_);
    if (from_corner.minCoeff() < 0 || from_corner.maxCoeff() > 2 * reach_) continue;
    const auto at = from_corner.cast<std::size_t>();
    window_[at.x() + regions_a_side * (at.y() + regions_a_side * at.z())] = static_cast<std::int32_t>(i);
  }
}

Int8 TsdfLanes::regions_by_table(const LatticePoints& region) const {
  Int8 numbers;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    numbers[lane] =
        volume_.find_region(origin_region_ + Eigen::Vector3i(region.x[lane], region.y[lane], region.z[lane]));
  }
  return numbers;
}

Float8 TsdfLanes::sample(const Points& at) const {
  const LatticePoints base = {floor_to_int(at.x), floor_to_int(at.y), floor_to_int(at.z)};
  const auto weights =
      trilinear_weights({at.x - to_float(base.x), at.y - to_float(base.y), at.z - to_float(base.z)});
  const Neighbourhood blocks(*this, base, 2);
  Float8 sum_m{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const LatticePoints voxel = {base.x + static_cast<int>(corner & 1),
                                 base.y + static_cast<int>((corner >> 1) & 1),
                                 base.z + static_cast<int>(corner >> 2)};
    const Int8 offset = (voxel.x & 7) + ((voxel.y & 7) << 3) + ((voxel.z & 7) << 6);
    sum_m += weights[corner] * distances_m(blocks.slot(voxel), offset);
  }
  return sum_m;
}

Points TsdfLanes::gradient(const Points& at) const {
  const LatticePoints base = {floor_to_int(at.x), floor_to_int(at.y), floor_to_int(at.z)};
  const auto weights =
      trilinear_weights({at.x - to_float(base.x), at.y - to_float(base.y), at.z - to_float(base.z)});
  const Neighbourhood blocks(*this, {base.x - 1, base.y - 1, base.z - 1}, 4);
  const auto distance_m = [&](int x, int y, int z) {
    const LatticePoints voxel = {base.x + x, base.y + y, base.z + z};
    const Int8 offset = (voxel.x & 7) + ((voxel.y & 7) << 3) + ((voxel.z & 7) << 6);
    return distances_m(blocks.slot(voxel), offset);
  };
  std::array<Float8, 8> corner_m;
  for (int c = 0; c < 8; ++c) {
    corner_m[static_cast<std::size_t>(c)] = distance_m(c & 1, (c >> 1) & 1, c >> 2);
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
      std::array<int, 3> before = {c & 1, (c >> 1) & 1, c >> 2};
      std::array<int, 3> after = before;
      before[static_cast<std::size_t>(axis)] = -1;
      after[static_cast<std::size_t>(axis)] = 2;
      sum +=
          weights[low] * slope(distance_m(before[0], before[1], before[2]), corner_m[low], corner_m[high]) +
          weights[high] * slope(corner_m[low], corner_m[high], distance_m(after[0], after[1], after[2]));
    }
    return sum;
  };
  return {along(0), along(1), along(2)};
}

}  // namespace fusebench
