#include "core/estimator/model/tsdf/tsdf_volume.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/model/tsdf/voxel_fusion.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::tsdf {
namespace {

constexpr std::size_t kBlocksPerChunk = 32;
constexpr std::size_t kReadBeyond = 1;  // gather() of halves reads pairs

}  // namespace

TsdfVolume::TsdfVolume(const config::TsdfConfig& config)
    : config_(std::make_shared<const config::TsdfConfig>(config)),
      voxel_m_(config.voxel_m),
      region_slots_(kRegionBlocks, -1) {
  distances_m_.grow_to(kBlockVoxels + kReadBeyond);
  std::fill_n(distances_m_.data(), kBlockVoxels + kReadBeyond, std::numeric_limits<simd::Half>::quiet_NaN());
}

Result<void> TsdfVolume::integrate(const RgbdFrame& frame, const PinholeCamera& camera,
                                   const SE3& T_world_camera, const config::DepthConfig& depth,
                                   const Workers& workers) {
  check(frame.depth_m.width == camera.width_px && frame.depth_m.height == camera.height_px,
        "the depth image has the camera's size");
  check(frame.color.empty() || frame.color.data.size() == frame.depth_m.data.size(),
        "the colour image has the depth image's size");
  // The bands are within this distance of the camera on each axis (written to fail for NaN).
  const double range_m = depth.max_m + truncation_m(depth.max_m, depth);
  const double ray_m = range_m * (camera.back_project(0, 0, 1.0).norm() +
                                  camera.back_project(camera.width_px, camera.height_px, 1.0).norm());
  if (!(T_world_camera.translation.cwiseAbs().maxCoeff() + ray_m < reach_m()) ||
      !T_world_camera.rotation.coeffs().allFinite()) {
    return fail(ErrorCode::run_failed,
                fmt::format("the camera of frame {} ns is outside the model's lattice (+-{} m)",
                            frame.timestamp_ns, reach_m()),
                "the estimate has diverged before this frame");
  }

  touched_.find(frame.depth_m, camera, T_world_camera, kBlockSide * voxel_m_, *config_, depth, frame_count_,
                workers);
  const Result<void> allocated = allocate();
  if (!allocated) return allocated;

  const VoxelUpdate update(frame, camera, T_world_camera, depth, *config_, frame_count_++);
  const std::vector<BlockIndex>& touched = touched_.blocks();
  for (const int slot : touched_slots_) last_fused_ns_[static_cast<std::size_t>(slot)] = frame.timestamp_ns;
  workers.for_chunks(touched.size(), kBlocksPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      update.apply(touched[i], block(static_cast<std::size_t>(touched_slots_[i])));
    }
  });
  return {};
}

// Slots of the touched blocks. Allocates the missing ones, all or none.
Result<void> TsdfVolume::allocate() {
  const std::vector<BlockIndex>& touched = touched_.blocks();
  touched_slots_.resize(touched.size());
  std::size_t added = 0;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    touched_slots_[i] = table_.find(touched[i]);
    if (touched_slots_[i] < 0) ++added;
  }
  const auto most = static_cast<std::size_t>(config_->max_blocks);
  if (block_count() + added > most) {
    const bool all_found = touched.size() <= most;
    return fail(ErrorCode::run_failed,
                fmt::format("the model is full: tsdf.max_blocks = {}, and this "
                            "frame needs {}{} more than the {} in use",
                            config_->max_blocks, all_found ? "" : "at least ", added, block_count()),
                "raise tsdf.max_blocks (about 4 kB each), enlarge "
                "tsdf.voxel_m, or lower depth.max_m");
  }
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched_slots_[i] >= 0) continue;
    touched_slots_[i] = static_cast<int>(block_count());
    add_block(touched[i]);
  }
  return {};
}

void TsdfVolume::add_block(const BlockIndex& index) {
  const std::size_t begin = block_count() * kBlockVoxels;
  const std::size_t end = begin + kBlockVoxels;
  distances_m_.grow_to(kBlockVoxels + end + kReadBeyond);
  weights_.grow_to(end);
  colors_.grow_to(end);
  std::fill_n(distances_m_.data() + kBlockVoxels + begin, kBlockVoxels + kReadBeyond,
              std::numeric_limits<simd::Half>::quiet_NaN());
  std::fill_n(weights_.data() + begin, kBlockVoxels, simd::Half(0.0F));
  std::fill_n(colors_.data() + begin, kBlockVoxels, std::uint32_t{0});
  const Eigen::Vector3i region = region_of(index);
  if (regions_.insert(region)) {
    region_indices_.push_back(region);
    region_slots_.insert(region_slots_.end(), kRegionBlocks, -1);
  }
  region_slots_[(static_cast<std::size_t>(regions_.find(region)) + 1) * kRegionBlocks +
                place_in_region(index)] = static_cast<std::int32_t>(block_count());
  table_.insert(index);
  indices_.push_back(index);
  last_fused_ns_.push_back(0);
}

BlockVoxels TsdfVolume::block(std::size_t slot) {
  const std::size_t begin = slot * kBlockVoxels;
  return {distances_m_.data() + kBlockVoxels + begin, weights_.data() + begin, colors_.data() + begin};
}

Voxel TsdfVolume::voxel(std::size_t slot, std::size_t offset) const {
  const std::size_t at = slot * kBlockVoxels + offset;
  const std::uint32_t color = colors_.data()[at];
  const auto byte = [color](int number) { return static_cast<std::uint8_t>(color >> (8 * number)); };
  return {static_cast<float>(distances_m()[at]),
          static_cast<float>(weights_.data()[at]),
          {byte(0), byte(1), byte(2)},
          byte(3)};
}

std::size_t TsdfVolume::memory_bytes() const {
  return distances_m_.memory_bytes() + weights_.memory_bytes() + colors_.memory_bytes() +
         indices_.capacity() * sizeof(BlockIndex) + last_fused_ns_.capacity() * sizeof(std::int64_t) +
         table_.memory_bytes() + regions_.memory_bytes() + region_slots_.capacity() * sizeof(std::int32_t);
}

double TsdfVolume::measurement_weight(double depth_m, const config::DepthConfig& depth) const {
  const double voxel_variance = voxel_m_ * voxel_m_;
  const double sigma_m = preprocessing::depth_sigma_m(depth_m, depth);
  return voxel_variance / (voxel_variance + sigma_m * sigma_m);
}

double TsdfVolume::truncation_m(double depth_m, const config::DepthConfig& depth) const {
  return half_band_m(depth_m, *config_, depth);
}

}  // namespace fusebench::tsdf
