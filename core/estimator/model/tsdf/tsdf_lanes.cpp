#include "core/estimator/model/tsdf/tsdf_lanes.hpp"

#include <algorithm>
#include <cmath>

#include "core/config/groups/frame_config.hpp"

namespace fusebench::tsdf {

namespace {

constexpr int kRegionVoxels = kRegionSide * kBlockSide;
/// Building a larger window of regions (16 MB) takes more time than it saves.
constexpr double kMaxWindowRegions = 1 << 22;

}  // namespace

/// A cube of kSide (at most eight) voxels from `first` on, which covers at most two blocks along each axis.
template <int kSide>
class TsdfLanes::Cube {
 public:
  Cube(const TsdfLanes& field, const LatticePoints& first)
      : field_(field), axes_{Axis(field, first.x, 0), Axis(field, first.y, 1), Axis(field, first.z, 2)} {
    for (std::size_t n = 0; n < 8; ++n) {
      // A second block is looked up only if some lane reaches it.
      const auto reached = [&](std::size_t axis) { return (n >> axis & 1) == 0 || axes_[axis].crossed; };
      if (!reached(0) || !reached(1) || !reached(2)) continue;
      slots_[n] = field.slots(axes_[0].block[n & 1], axes_[1].block[n >> 1 & 1], axes_[2].block[n >> 2]);
    }
  }

  /// The distances at a voxel of the cube and at the next one along x.
  [[nodiscard]] simd::Pairs pair_m(int x, int y, int z) const {
    const Place& at_x = axes_[0].places[static_cast<std::size_t>(x)];
    const simd::Int8 offset = axes_[1].places[static_cast<std::size_t>(y)].offset +
                              axes_[2].places[static_cast<std::size_t>(z)].offset;
    const simd::Pairs pair_m = field_.pairs_m(slot(x, y, z), at_x.offset + offset);
    const Place& next = axes_[0].places[static_cast<std::size_t>(x) + 1];
    if (!next.begins_block) return pair_m;
    return {pair_m.first, field_.distances_m(slot(x + 1, y, z), next.offset + offset)};
  }

 private:
  struct Place {
    simd::Int8 offset;  ///< share of this axis in the offset within the block
    simd::Int8 second;  ///< true if in the second block
    bool begins_block;  ///< in any lane: the previous voxel is in another block
  };
  struct Axis {
    Axis(const TsdfLanes& field, simd::Int8 first, int axis) {
      const simd::Int8 first_block = first >> 3;
      const simd::Int8 last_block = (first + (kSide - 1)) >> 3;
      crossed = simd::any(first_block != last_block);
      block[0] = field.block_axis(first_block, axis);
      if (crossed) block[1] = field.block_axis(last_block, axis);
      for (int i = 0; i < kSide; ++i) {
        const simd::Int8 at = first + i;
        places[static_cast<std::size_t>(i)] = {(at & 7) << (3 * axis), (at >> 3) != first_block,
                                               crossed && simd::any((at & 7) == 0)};
      }
    }
    std::array<BlockAxis, 2> block;  ///< the second one is set only if it is crossed into
    bool crossed;                    ///< true if any lane reaches the second block
    std::array<Place, static_cast<std::size_t>(kSide)> places;
  };

  [[nodiscard]] simd::Int8 slot(int x, int y, int z) const {
    const auto second = [&](std::size_t axis, int at) {
      return axes_[axis].places[static_cast<std::size_t>(at)].second;
    };
    const auto across = [&](std::size_t n) {
      return axes_[0].crossed && x > 0 ? (second(0, x) ? slots_[n | 1] : slots_[n]) : slots_[n];
    };
    const auto down = [&](std::size_t n) {
      return axes_[1].crossed && y > 0 ? (second(1, y) ? across(n | 2) : across(n)) : across(n);
    };
    return axes_[2].crossed && z > 0 ? (second(2, z) ? down(4) : down(0)) : down(0);
  }

  const TsdfLanes& field_;
  std::array<Axis, 3> axes_;
  std::array<simd::Int8, 8> slots_;  // number: bit 0: second block along x, bit 1: y, bit 2: z
};

TsdfLanes::TsdfLanes(const TsdfVolume& volume, const Vector3d& centre_world, double reach_m)
    : volume_(volume),
      origin_region_((centre_world / (kRegionVoxels * volume.voxel_m())).array().floor().cast<int>()),
      origin_voxel_(origin_region_.cast<double>() * kRegionVoxels),
      reach_(static_cast<int>(std::ceil(reach_m / (kRegionVoxels * volume.voxel_m()))) + 2) {
  const double side = 2.0 * reach_ + 1.0;
  window_step_ = {};
  if (side * side * side > kMaxWindowRegions) return;
  const auto regions_a_side = static_cast<std::size_t>(side);
  const auto step = static_cast<std::int32_t>(regions_a_side);
  window_step_ = {1, step, step * step};
  window_.assign(regions_a_side * regions_a_side * regions_a_side, -1);
  const std::vector<Eigen::Vector3i>& regions = volume.region_indices();
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Eigen::Vector3i from_corner = regions[i] - origin_region_ + Eigen::Vector3i::Constant(reach_);
    if (from_corner.minCoeff() < 1 || from_corner.maxCoeff() > 2 * reach_ - 1) continue;
    const auto at = from_corner.cast<std::size_t>();
    window_[at.x() + regions_a_side * (at.y() + regions_a_side * at.z())] = static_cast<std::int32_t>(i);
  }
}

simd::Int8 TsdfLanes::regions_by_table(const LatticePoints& region) const {
  simd::Int8 numbers;
  for (std::size_t lane = 0; lane < simd::kLanes; ++lane) {
    numbers[lane] =
        volume_.find_region(origin_region_ + Eigen::Vector3i(region.x[lane], region.y[lane], region.z[lane]));
  }
  return numbers;
}

simd::Float8 TsdfLanes::sample(const simd::Points& at) const {
  const TrilinearCell cell(at);
  return interpolated_m(cell, Cube<2>(*this, cell.base));
}

simd::Points TsdfLanes::gradient(const simd::Points& at) const {
  const TrilinearCell cell(at);
  return interpolated_gradient(cell, Cube<4>(*this, {cell.base.x - 1, cell.base.y - 1, cell.base.z - 1}));
}

std::optional<TsdfLanes> field_in_view(const TsdfVolume& volume, const PinholeCamera& camera,
                                       const SE3& T_world_camera, const config::DepthConfig& depth) {
  const double corner = std::max(camera.back_project(0, 0, 1.0).norm(),
                                 camera.back_project(camera.width_px, camera.height_px, 1.0).norm());
  const double reach_m = depth.max_m * corner;
  // False for a pose that is not finite too.
  if (volume.block_count() == 0 ||
      !(T_world_camera.translation.cwiseAbs().maxCoeff() + reach_m < volume.reach_m()) ||
      !T_world_camera.rotation.coeffs().allFinite()) {
    return std::nullopt;
  }
  return TsdfLanes(volume, T_world_camera.translation, reach_m);
}

}  // namespace fusebench::tsdf
