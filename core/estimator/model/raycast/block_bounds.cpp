#include "core/estimator/model/raycast/block_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/config/groups/frame_config.hpp"

namespace fusebench::raycast {

namespace {

constexpr int kTile_px = 16;
constexpr float kTiles_per_px = 1.0F / static_cast<float>(kTile_px);
constexpr double kMargin_px = 1.0;

/// Range of tiles along one axis that a sphere may cover, from its extent along that axis and along z.
BlockBounds::Range range_of(double low_m, double high_m, double near_m, double far_m, double focal_px,
                            double centre_px, int tiles) {
  const double first_px = focal_px * low_m / (low_m > 0 ? far_m : near_m) + centre_px - kMargin_px;
  const double last_px = focal_px * high_m / (high_m > 0 ? near_m : far_m) + centre_px + kMargin_px;
  const auto tile = [&](double px, double least, double most) {
    return static_cast<int>(std::clamp(std::floor(px / kTile_px), least, most));
  };
  return {tile(first_px, 0.0, tiles), tile(last_px, -1.0, tiles - 1.0)};
}

}  // namespace

/// Bounding sphere of a block or region, camera axes, metres.
struct BlockBounds::Sphere {
  Vector3d centre_camera;
  double radius_m;

  [[nodiscard]] double near_m() const { return centre_camera.z() - radius_m; }
  [[nodiscard]] double far_m() const { return centre_camera.z() + radius_m; }
};

BlockBounds::BlockBounds(const tsdf::TsdfVolume& volume, const PinholeCamera& camera,
                         const SE3& T_world_camera, const config::DepthConfig& depth)
    : camera_(camera),
      T_camera_world_(T_world_camera.inverse()),
      R_camera_world_(T_camera_world_.rotation_matrix()),
      voxel_m_(volume.voxel_m()),
      min_m_(std::max(depth.min_m, 1e-3)),
      max_m_(depth.max_m),
      tiles_m_((camera.width_px + kTile_px - 1) / kTile_px, (camera.height_px + kTile_px - 1) / kTile_px,
               std::numeric_limits<float>::infinity()) {
  for (std::size_t region = 0; region < volume.region_indices().size(); ++region) add_region(volume, region);
}

void BlockBounds::add_region(const tsdf::TsdfVolume& volume, std::size_t region) {
  // Interpolation uses samples up to one voxel beyond a block.
  const auto radius_m = [&](int voxels) { return (0.5 * std::sqrt(3.0) * voxels + 1.0) * voxel_m_; };
  const auto centre = [&](const Eigen::Vector3i& index, int voxels) -> Vector3d {
    const Vector3d centre_world = (index.cast<double>().array() + 0.5) * (voxels * voxel_m_);
    return R_camera_world_ * centre_world + T_camera_world_.translation;
  };
  constexpr int kRegionVoxels = tsdf::kRegionSide * tsdf::kBlockSide;
  const Eigen::Vector3i& index = volume.region_indices()[region];
  const Tiles of_region = tiles_of({centre(index, kRegionVoxels), radius_m(kRegionVoxels)});
  if (of_region.rows.empty() || of_region.columns.empty()) return;
  const std::int32_t* const slots = volume.region_slots() + region * tsdf::kRegionBlocks;
  for (int n = 0; n < static_cast<int>(tsdf::kRegionBlocks); ++n) {
    if (slots[n] < 0) continue;
    const Eigen::Vector3i block = index * tsdf::kRegionSide + Eigen::Vector3i(n & 3, (n >> 2) & 3, n >> 4);
    add(tiles_of({centre(block, tsdf::kBlockSide), radius_m(tsdf::kBlockSide)}));
  }
}

BlockBounds::Tiles BlockBounds::tiles_of(const Sphere& sphere) const {
  const double near_m = std::max(sphere.near_m(), min_m_);
  const double far_m = sphere.far_m();
  if (far_m < near_m || near_m > max_m_) return {{0, -1}, {0, -1}, 0};
  const Vector3d& at = sphere.centre_camera;
  const double r = sphere.radius_m;
  return {range_of(at.x() - r, at.x() + r, near_m, far_m, camera_.fx_px, camera_.cx_px, tiles_m_.width),
          range_of(at.y() - r, at.y() + r, near_m, far_m, camera_.fy_px, camera_.cy_px, tiles_m_.height),
          static_cast<float>(near_m)};
}

void BlockBounds::add(const Tiles& tiles) {
  for (int y = tiles.rows.first; y <= tiles.rows.last; ++y) {
    for (int x = tiles.columns.first; x <= tiles.columns.last; ++x) {
      tiles_m_(x, y) = std::min(tiles_m_(x, y), tiles.near_m);
    }
  }
}

simd::Float8 BlockBounds::nearest_m(simd::Float8 u_px, simd::Float8 v_px) const {
  const simd::Int8 inside = (u_px >= 0.0F) & (v_px >= 0.0F) &
                            (u_px <= static_cast<float>(camera_.width_px - 1)) &
                            (v_px <= static_cast<float>(camera_.height_px - 1));
  const simd::Int8 x = simd::to_int(inside ? u_px * kTiles_per_px : simd::Float8{});
  const simd::Int8 y = simd::to_int(inside ? v_px * kTiles_per_px : simd::Float8{});
  const simd::Float8 bound_m = simd::gather(tiles_m_.data.data(), y * tiles_m_.width + x);
  return inside ? bound_m : simd::Float8{};
}

}  // namespace fusebench::raycast
