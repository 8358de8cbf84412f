#include "core/voxel_update.hpp"

#include <algorithm>

namespace fusebench {
namespace {

static_assert(kBlockSide == kLanes, "a row of a block is one vector");

// With more, a step of the colour's mean would fall below the resolution of its storage (half of 1/256
// level).
constexpr float kMaxColorCount = 255.0F;

Float8 of_row(const Voxel* row, float Voxel::*member) {
  const Float8 values = {row[0].*member, row[1].*member, row[2].*member, row[3].*member,
                         row[4].*member, row[5].*member, row[6].*member, row[7].*member};
  return values;
}

}  // namespace

VoxelUpdate::VoxelUpdate(const RgbdFrame& frame, const PinholeCamera& camera, const SE3& T_world_camera,
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

void VoxelUpdate::apply(const BlockIndex& index, VoxelBlock& block) const {
  const Vector3d corner_world = index.cast<double>() * (kBlockSide * voxel_m_);
  const Eigen::Vector3f corner_camera = (T_camera_world_ * corner_world).cast<float>();
  const Eigen::Vector3f step = step_camera_.col(0);
  const Float8 step_x = kLaneNumber * step.x();
  const Float8 step_y = kLaneNumber * step.y();
  const Float8 step_z = kLaneNumber * step.z();
  Voxel* row = block.data();
  for (int z = 0; z < kBlockSide; ++z) {
    for (int y = 0; y < kBlockSide; ++y, row += kBlockSide) {
      const Eigen::Vector3f begin_camera = corner_camera + static_cast<float>(y) * step_camera_.col(1) +
                                           static_cast<float>(z) * step_camera_.col(2);
      observe_row(begin_camera.x() + step_x, begin_camera.y() + step_y, begin_camera.z() + step_z, row);
    }
  }
}

// Noise of a measurement, in double precision as everywhere else.
Float8 VoxelUpdate::sigma_m(Float8 depth_m) const {
  using Double8 [[gnu::vector_size(64)]] = double;
  const Double8 z = __builtin_convertvector(depth_m, Double8) - depth_.noise_offset_m;
  return __builtin_convertvector(depth_.noise_floor_m + depth_.noise_quadratic_per_m * z * z, Float8);
}

// x, y, z: the voxels of a row in the camera frame.
void VoxelUpdate::observe_row(Float8 x_m, Float8 y_m, Float8 z_m, Voxel* row) const {
  const DepthImage& depth_m = frame_.depth_m;
  const Float8 inverse_z = 1.0F / z_m;
  // Half a pixel more, so that cutting the fraction off rounds to the nearest pixel.
  const Float8 u = fx_ * x_m * inverse_z + cx_ + 0.5F;
  const Float8 v = fy_ * y_m * inverse_z + cy_ + 0.5F;
  const Int8 inside = (z_m > 0.0F) & (u >= 0.0F) & (v >= 0.0F) & (u < static_cast<float>(depth_m.width)) &
                      (v < static_cast<float>(depth_m.height));
  if (!any(inside)) return;
  // Lanes outside take pixel 0, which is there to read but not used.
  const Float8 zero{};
  const Int8 pixel = to_int(inside ? v : zero) * depth_m.width + to_int(inside ? u : zero);
  const Float8 measured_m = gather(depth_m.data.data(), pixel);
  const Float8 sigma = sigma_m(measured_m);
  const Float8 band_m = max(all_lanes(truncation_m_), truncation_sigmas_ * sigma);
  const Float8 distance_m = measured_m - z_m;
  // Further behind the surface than the band, a voxel is hidden.
  const Int8 observed = inside & (measured_m >= static_cast<float>(depth_.min_m)) &
                        (measured_m <= static_cast<float>(depth_.max_m)) & (distance_m > -band_m);
  if (!any(observed)) return;

  // What lies deep behind the surface is a guess, and wrong where a ray clips an edge and comes out again.
  const Float8 trust = min(all_lanes(1.0F), (band_m + distance_m) / (0.5F * band_m));
  const Float8 weight = trust * voxel_variance_ / (voxel_variance_ + sigma * sigma);
  fuse_row(min(distance_m, band_m), weight, observed, row);
  if (frame_.color.empty()) return;
  const Float8 from_surface_m = distance_m < 0.0F ? -distance_m : distance_m;
  const Int8 colored = observed & (from_surface_m < 0.5F * band_m);
  for (std::size_t x = 0; x < kLanes; ++x) {
    if (colored[x] != 0) add_color(frame_.color.data[static_cast<std::size_t>(pixel[x])], row[x]);
  }
}

// The running means of the distance, where observed.
void VoxelUpdate::fuse_row(Float8 distance_m, Float8 weight, Int8 observed, Voxel* row) const {
  Float8 mean_m = of_row(row, &Voxel::distance_m);
  Float8 sum = of_row(row, &Voxel::weight);
  const Float8 total = sum + weight;
  mean_m = observed ? (mean_m * sum + distance_m * weight) / total : mean_m;
  sum = observed ? min(total, all_lanes(max_weight_)) : sum;
  for (std::size_t x = 0; x < kLanes; ++x) {
    row[x].distance_m = mean_m[x];
    row[x].weight = sum[x];
  }
}

// The running mean of the colour: all three channels at once, beside the count.
void VoxelUpdate::add_color(const Rgb& observed, Voxel& voxel) const {
  using Float4 [[gnu::vector_size(16)]] = float;
  using Int4 [[gnu::vector_size(16)]] = std::int32_t;
  using Short4 [[gnu::vector_size(8)]] = std::uint16_t;
  const auto [red, green, blue] = voxel.color;
  const Short4 stored = {red, green, blue, voxel.color_count};
  const Int4 levels = {observed[0], observed[1], observed[2], 0};
  // By way of 32 bits, for which there are instructions.
  const Float4 mean = __builtin_convertvector(__builtin_convertvector(stored, Int4), Float4);
  const Float4 target = 256.0F * __builtin_convertvector(levels, Float4);
  const float count = mean[3] + 1.0F;
  Float4 next = mean + (target - mean) * (1.0F / count) + 0.5F;
  next[3] = std::min(count, max_color_count_);
  const auto rounded = __builtin_convertvector(__builtin_convertvector(next, Int4), Short4);
  voxel.color = {rounded[0], rounded[1], rounded[2]};
  voxel.color_count = rounded[3];
}

}  // namespace fusebench
