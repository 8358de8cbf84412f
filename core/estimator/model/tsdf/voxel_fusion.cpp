#include "core/estimator/model/tsdf/voxel_fusion.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/base/bits.hpp"
#include "core/base/simd/image_lanes.hpp"
#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/preprocessing/depth_gates.hpp"

namespace fusebench::tsdf {
namespace {

using simd::lane_details::byte_of;

static_assert(kBlockSide == simd::kLanes, "a row of a block is one vector");

// Smaller weights count as zero: below this, half precision has fewer than eleven significant bits.
constexpr float kMinWeight = 0x1p-14F;
constexpr float kMaxColorCount = 255.0F;  // of a byte
constexpr int kCountByte = 3;

// A larger value, added to 255, would round to 256.
constexpr float kMaxRounding = 1.0F - 0x1p-16F;

/// A number from 0 to kMaxRounding for each frame, evenly distributed over consecutive frames: multiples of
/// the golden ratio (Weyl 1916).
float spread(std::uint32_t frame_number) {
  return std::min(static_cast<float>((frame_number * 0x9E3779B9U) >> 8) / static_cast<float>(1U << 24),
                  kMaxRounding);
}

}  // namespace

VoxelUpdate::VoxelUpdate(const RgbdFrame& frame, const PinholeCamera& camera, const SE3& T_world_camera,
                         const config::DepthConfig& depth, const config::TsdfConfig& tsdf,
                         std::uint32_t frame_number)
    : frame_(frame),
      T_camera_world_(T_world_camera.inverse()),
      voxel_m_(tsdf.voxel_m),
      step_camera_((T_camera_world_.rotation_matrix() * tsdf.voxel_m).cast<float>()),
      fx_(static_cast<float>(camera.fx_px)),
      fy_(static_cast<float>(camera.fy_px)),
      cx_(static_cast<float>(camera.cx_px)),
      cy_(static_cast<float>(camera.cy_px)),
      nearest_m_(static_cast<float>(depth.min_m)),
      farthest_m_(static_cast<float>(depth.max_m)),
      depth_sigma_(depth),
      truncation_m_(static_cast<float>(std::max(tsdf.truncation_m, 2.0 * tsdf.voxel_m))),
      truncation_sigmas_(static_cast<float>(tsdf.truncation_sigmas)),
      voxel_variance_(static_cast<float>(tsdf.voxel_m * tsdf.voxel_m)),
      max_weight_(static_cast<float>(tsdf.max_weight)),
      max_color_count_(std::min(max_weight_, kMaxColorCount)),
      color_rounding_(spread(frame_number)) {}

// Processes a slice at a time, each step for all of its rows. The rows that need the next step are known
// before it, which avoids branch mispredictions.
void VoxelUpdate::apply(const BlockIndex& index, const BlockVoxels& block) const {
  const Vector3d corner_world = index.cast<double>() * (kBlockSide * voxel_m_);
  const Eigen::Vector3f corner_camera = (T_camera_world_ * corner_world).cast<float>();
  const Eigen::Vector3f step = step_camera_.col(0);
  const simd::Float8 step_x = simd::kLaneNumber * step.x();
  const simd::Float8 step_y = simd::kLaneNumber * step.y();
  const simd::Float8 step_z = simd::kLaneNumber * step.z();
  constexpr std::size_t kRows = kBlockSide;
  std::array<SeenRow, kRows> rows;
  std::array<simd::Int8, kRows> colored;
  for (std::size_t z = 0; z < kRows; ++z) {
    const std::size_t slice = z * kRows * simd::kLanes;
    unsigned seen_rows = 0;
    for (std::size_t y = 0; y < kRows; ++y) {
      const Eigen::Vector3f begin_camera = corner_camera + static_cast<float>(y) * step_camera_.col(1) +
                                           static_cast<float>(z) * step_camera_.col(2);
      rows[y] = look(begin_camera.x() + step_x, begin_camera.y() + step_y, begin_camera.z() + step_z);
      seen_rows |= (simd::any(rows[y].seen) ? 1U : 0U) << y;
    }
    unsigned colored_rows = 0;
    for_each_bit(seen_rows, [&](std::size_t y) {
      colored[y] = add_distance(rows[y], block, slice + y * simd::kLanes);
      colored_rows |= (simd::any(colored[y]) ? 1U : 0U) << y;
    });
    if (frame_.color.empty()) continue;
    for_each_bit(colored_rows, [&](std::size_t y) {
      add_color(rows[y].pixel, colored[y], block, slice + y * simd::kLanes);
    });
  }
}

simd::Float8 VoxelUpdate::band_m(simd::Float8 sigma_m) const {
  return simd::max(simd::all_lanes(truncation_m_), truncation_sigmas_ * sigma_m);
}

// x, y, z: the voxels of a row in the camera frame.
VoxelUpdate::SeenRow VoxelUpdate::look(simd::Float8 x_m, simd::Float8 y_m, simd::Float8 z_m) const {
  const DepthImage& depth_m = frame_.depth_m;
  const simd::Float8 inverse_z = 1.0F / z_m;
  // Adds half a pixel, so that truncation rounds to the nearest pixel.
  const simd::Float8 u = simd::multiply_add(fx_ * x_m, inverse_z, simd::all_lanes(cx_ + 0.5F));
  const simd::Float8 v = simd::multiply_add(fy_ * y_m, inverse_z, simd::all_lanes(cy_ + 0.5F));
  const simd::Int8 inside = (z_m > 0.0F) & (u >= 0.0F) & (v >= 0.0F) &
                            (u < static_cast<float>(depth_m.width)) &
                            (v < static_cast<float>(depth_m.height));
  // Lanes outside the image read pixel 0 and ignore it.
  const simd::Float8 zero{};
  const simd::Int8 pixel = simd::to_int(inside ? v : zero) * depth_m.width + simd::to_int(inside ? u : zero);
  const simd::Float8 measured_m = simd::gather(depth_m.data.data(), pixel);
  const simd::Float8 distance_m = measured_m - z_m;
  // Voxels farther behind the surface than the band are occluded.
  const simd::Int8 seen = inside & (measured_m >= nearest_m_) & (measured_m <= farthest_m_) &
                          (distance_m > -band_m(depth_sigma_.at_m(measured_m)));
  return {pixel, measured_m, distance_m, seen};
}

// Returns the voxels that are close enough to the surface to take its colour.
simd::Int8 VoxelUpdate::add_distance(const SeenRow& seen, const BlockVoxels& block, std::size_t row) const {
  const simd::Float8 sigma_m = depth_sigma_.at_m(seen.measured_m);
  const simd::Float8 band = band_m(sigma_m);
  // Far behind the surface the projective distance is unreliable. It is wrong where a ray passes an edge and
  // leaves the surface again.
  const simd::Float8 half_m = 0.5F * band;
  const simd::Float8 weight =
      simd::min(half_m, band + seen.distance_m) * voxel_variance_ /
      (half_m * simd::multiply_add(sigma_m, sigma_m, simd::all_lanes(voxel_variance_)));
  const simd::Int8 observed = seen.seen & (weight >= kMinWeight);
  // Running mean; an unobserved voxel has no previous distance.
  const simd::Float8 before_m = simd::load(block.distance_m + row);
  const simd::Float8 before = simd::load(block.weight + row);
  const simd::Float8 total = before + weight;
  const simd::Float8 mean_m = simd::multiply_add(before > 0.0F ? before_m : simd::Float8{}, before,
                                                 simd::min(seen.distance_m, band) * weight) /
                              total;
  simd::store(observed ? mean_m : before_m, block.distance_m + row);
  simd::store(observed ? simd::min(total, simd::all_lanes(max_weight_)) : before, block.weight + row);
  return observed & (simd::abs(seen.distance_m) < half_m);
}

// Running means of the three channels. A mean changes by less than a level, so rounding to nearest would stop
// it; stochastic rounding keeps it moving.
void VoxelUpdate::add_color(simd::Int8 pixel, simd::Int8 colored, const BlockVoxels& block,
                            std::size_t row) const {
  static_assert(sizeof(Rgb) == 3);
  const simd::Int8 levels =
      simd::gather_bytes(frame_.color.data.data()->data(), 3 * frame_.color.data.size(), 3 * pixel);
  simd::Int8 stored;
  std::memcpy(&stored, block.color + row, sizeof(stored));
  const simd::Float8 count = byte_of(stored, kCountByte) + 1.0F;
  const simd::Float8 share = 1.0F / count;
  simd::Int8 words = simd::to_int(simd::min(count, simd::all_lanes(max_color_count_))) << (8 * kCountByte);
  for (int channel = 0; channel < 3; ++channel) {
    const simd::Float8 mean = byte_of(stored, channel);
    const simd::Float8 moved = simd::multiply_add(byte_of(levels, channel) - mean, share, mean);
    words |= simd::to_int(moved + color_rounding_) << (8 * channel);
  }
  stored = colored ? words : stored;
  std::memcpy(block.color + row, &stored, sizeof(stored));
}

}  // namespace fusebench::tsdf
