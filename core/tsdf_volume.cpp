#include "core/tsdf_volume.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "core/band_blocks.hpp"
#include "core/depth_gates.hpp"
#include "core/tsdf_sampler.hpp"

namespace fusebench {
namespace {

constexpr std::size_t kBlocksPerChunk = 32;
// With more, a step of the colour's mean would fall below the resolution of its storage (half of 1/256
// level).
constexpr float kMaxColorCount = 255.0F;

// One frame as the voxels see it. Single precision: an error of 1e-7 of the depth is far below the depth
// noise.
class FrameUpdate {
 public:
  FrameUpdate(const RgbdFrame& frame, const PinholeCamera& camera, const SE3& T_world_camera,
              const DepthConfig& depth, const TsdfConfig& tsdf)
      : frame_(frame),
        depth_(depth),
        T_camera_world_(T_world_camera.inverse()),
        voxel_m_(tsdf.voxel_m),
        step_camera_((T_camera_world_.rotation_matrix() * tsdf.voxel_m).cast<float>()),
        fx_(static_cast<float>(camera.fx_px)),
        fy_(static_cast<float>(camera.fy_px)),
        cx_(static_cast<float>(camera.cx_px)),
        cy_(static_cast<float>(camera.cy_px)),
        truncation_m_(static_cast<float>(std::max(tsdf.truncation_m, 2.0 * tsdf.voxel_m))),
        truncation_sigmas_(static_cast<float>(tsdf.truncation_sigmas)),
        voxel_variance_(static_cast<float>(tsdf.voxel_m * tsdf.voxel_m)),
        max_weight_(static_cast<float>(tsdf.max_weight)),
        max_color_count_(std::min(max_weight_, kMaxColorCount)) {}

  void apply(const BlockIndex& index, VoxelBlock& block) const {
    const Vector3d corner_world = index.cast<double>() * (kBlockSide * voxel_m_);
    const Eigen::Vector3f corner_camera = (T_camera_world_ * corner_world).cast<float>();
    const Eigen::Vector3f step = step_camera_.col(0);
    Voxel* voxel = block.data();
    for (int z = 0; z < kBlockSide; ++z) {
      for (int y = 0; y < kBlockSide; ++y) {
        const Eigen::Vector3f row_camera = corner_camera + static_cast<float>(y) * step_camera_.col(1) +
                                           static_cast<float>(z) * step_camera_.col(2);
        for (int x = 0; x < kBlockSide; ++x, ++voxel) {
          const auto k = static_cast<float>(x);
          observe(row_camera.x() + k * step.x(), row_camera.y() + k * step.y(), row_camera.z() + k * step.z(),
                  *voxel);
        }
      }
    }
  }

 private:
  // x, y, z: the voxel in the camera frame.
  void observe(float x, float y, float z, Voxel& voxel) const {
    if (z <= 0.0F) return;
    const float inverse_z = 1.0F / z;
    // Half a pixel more, so that cutting the fraction off rounds to the nearest pixel.
    const float u = fx_ * x * inverse_z + cx_ + 0.5F;
    const float v = fy_ * y * inverse_z + cy_ + 0.5F;
    if (!(u >= 0.0F && v >= 0.0F && u < static_cast<float>(frame_.depth_m.width) &&
          v < static_cast<float>(frame_.depth_m.height))) {
      return;
    }
    const std::size_t pixel = frame_.depth_m.index(static_cast<int>(u), static_cast<int>(v));
    const float measured_m = frame_.depth_m.data[pixel];
    if (!(measured_m >= static_cast<float>(depth_.min_m) && measured_m <= static_cast<float>(depth_.max_m)))
      return;
    const auto sigma_m = static_cast<float>(depth_sigma_m(measured_m, depth_));
    const float band_m = std::max(truncation_m_, truncation_sigmas_ * sigma_m);
    const float distance_m = measured_m - z;
    if (distance_m <= -band_m) return;  // hidden behind the surface

    // What lies deep behind the surface is a guess, and wrong where a ray clips an edge and comes out again.
    const float trust = std::min(1.0F, (band_m + distance_m) / (0.5F * band_m));
    const float weight = trust * voxel_variance_ / (voxel_variance_ + sigma_m * sigma_m);
    const float total = voxel.weight + weight;
    voxel.distance_m = (voxel.distance_m * voxel.weight + std::min(distance_m, band_m) * weight) / total;
    voxel.weight = std::min(total, max_weight_);
    if (!frame_.color.empty() && std::abs(distance_m) < 0.5F * band_m)
      add_color(frame_.color.data[pixel], voxel);
  }

  void add_color(const Rgb& observed, Voxel& voxel) const {
    const auto count = static_cast<float>(voxel.color_count);
    const float share = 1.0F / (count + 1.0F);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const auto mean = static_cast<float>(voxel.color[channel]);
      const float target = 256.0F * static_cast<float>(observed[channel]);
      voxel.color[channel] = static_cast<std::uint16_t>(mean + (target - mean) * share + 0.5F);
    }
    voxel.color_count = static_cast<std::uint16_t>(std::min(count + 1.0F, max_color_count_));
  }

  const RgbdFrame& frame_;
  const DepthConfig& depth_;
  SE3 T_camera_world_;
  double voxel_m_;
  Eigen::Matrix3f step_camera_;  // columns: one voxel along each axis of the world, in the camera frame
  float fx_, fy_, cx_, cy_;      // pixels
  float truncation_m_;
  float truncation_sigmas_;
  float voxel_variance_;  // m^2
  float max_weight_;
  float max_color_count_;
};

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

  const std::vector<BlockIndex> touched = band_blocks(
      frame.depth_m, camera, T_world_camera, kBlockSide * config_.voxel_m, depth,
      [&](double depth_m) { return truncation_m(depth_m, depth); }, workers);
  const Result<std::vector<int>> slots = allocate(touched);
  if (!slots) return tl::unexpected(slots.error());

  const FrameUpdate update(frame, camera, T_world_camera, depth, config_);
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
    return fail(
        ErrorCode::run_failed,
        fmt::format(
            "the model is full: tsdf.max_blocks = {}, and this frame needs {} more than the {} in use",
            config_.max_blocks, added, blocks_.size()),
        "raise tsdf.max_blocks (about 8 kB each), enlarge tsdf.voxel_m, or lower depth.max_m");
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

double TsdfVolume::truncation_m(double depth_m, const DepthConfig& depth) const {
  return std::max({config_.truncation_m, 2.0 * config_.voxel_m,
                   config_.truncation_sigmas * depth_sigma_m(depth_m, depth)});
}

}  // namespace fusebench
