#include "core/tsdf_volume.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "core/band_blocks.hpp"
#include "core/depth_gates.hpp"
#include "core/tsdf_sampler.hpp"
#include "core/voxel_update.hpp"

namespace fusebench {
namespace {

constexpr std::size_t kBlocksPerChunk = 32;

}  // namespace

Result<void> TsdfVolume::integrate(const RgbdFrame& frame, const PinholeCamera& camera,
                                   const SE3& T_world_camera, const DepthConfig& depth,
                                   const Workers& workers) {
  check(frame.depth_m.width == camera.width_px && frame.depth_m.height == camera.height_px,
        "the depth image has the camera's size");
  check(frame.color.empty() || frame.color.data.size() == frame.depth_m.data.size(),
        "the colour image has the depth image's size");
  // The furthest point of a band lies within this many metres of the camera, on each axis (written to fail
  // for NaN).
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

  const std::vector<BlockIndex> touched = band_blocks(frame.depth_m, camera, T_world_camera,
                                                      kBlockSide * config_.voxel_m, config_, depth, workers);
  const Result<std::vector<int>> slots = allocate(touched);
  if (!slots) return tl::unexpected(slots.error());

  const VoxelUpdate update(frame, camera, T_world_camera, depth, config_);
  workers.for_chunks(touched.size(), kBlocksPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      update.apply(touched[i], blocks_[static_cast<std::size_t>((*slots)[i])]);
    }
  });
  return {};
}

// Slots of the touched blocks; those that are missing get new ones, all of them or none.
Result<std::vector<int>> TsdfVolume::allocate(const std::vector<BlockIndex>& touched) {
  std::vector<int> slots(touched.size());
  std::size_t added = 0;
  for (std::size_t i = 0; i < touched.size(); ++i) {
    slots[i] = table_.find(touched[i]);
    if (slots[i] < 0) ++added;
  }
  if (blocks_.size() + added > static_cast<std::size_t>(config_.max_blocks)) {
    return fail(ErrorCode::run_failed,
                fmt::format("the model is full: tsdf.max_blocks = {}, and this "
                            "frame needs {} more than the {} in use",
                            config_.max_blocks, added, blocks_.size()),
                "raise tsdf.max_blocks (about 8 kB each), enlarge "
                "tsdf.voxel_m, or lower depth.max_m");
  }
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (slots[i] >= 0) continue;
    slots[i] = static_cast<int>(blocks_.size());
    table_.insert(touched[i]);
    regions_.insert(region_of(touched[i]));
    indices_.push_back(touched[i]);
    blocks_.emplace_back();
  }
  return slots;
}

std::size_t TsdfVolume::memory_bytes() const {
  return blocks_.size() * sizeof(VoxelBlock) + indices_.capacity() * sizeof(BlockIndex) +
         table_.memory_bytes() + regions_.memory_bytes();
}

const Voxel* TsdfVolume::find_voxel(const VoxelIndex& index) const {
  const int slot = table_.find(block_of(index));
  return slot < 0 ? nullptr : &blocks_[static_cast<std::size_t>(slot)][offset_in_block(index)];
}

TsdfSample TsdfVolume::sample(const Vector3d& point_world) const {
  return TsdfSampler(*this).sample(point_world);
}

double TsdfVolume::measurement_weight(double depth_m, const DepthConfig& depth) const {
  const double voxel_variance = config_.voxel_m * config_.voxel_m;
  const double sigma_m = depth_sigma_m(depth_m, depth);
  return voxel_variance / (voxel_variance + sigma_m * sigma_m);
}

double TsdfVolume::truncation_m(double depth_m, const DepthConfig& depth) const {
  return half_band_m(depth_m, config_, depth);
}

}  // namespace fusebench
