// One voxel after the other, by the same formulas as VoxelUpdate: what its eight lanes must agree with.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "core/estimator/model/tsdf/tsdf_volume.hpp"

namespace fusebench::testing {

using PlainBlock = std::array<tsdf::Voxel, tsdf::kBlockVoxels>;

class PlainVoxelUpdate {
 public:
  PlainVoxelUpdate(const RgbdFrame& frame, const PinholeCamera& camera, const SE3& T_world_camera,
                   const config::DepthConfig& depth, const config::TsdfConfig& tsdf,
                   std::uint32_t frame_number)
      : frame_(frame),
        camera_(camera),
        T_camera_world_(T_world_camera.inverse()),
        depth_(depth),
        tsdf_(tsdf),
        color_rounding_(std::min(static_cast<float>((frame_number * 2654435769U) >> 8) / 16777216.0F,
                                 65535.0F / 65536.0F)) {}

  void apply(const tsdf::BlockIndex& index, PlainBlock& block) const {
    const Vector3d corner = index.cast<double>() * (tsdf::kBlockSide * tsdf_.voxel_m);
    const Eigen::Vector3f corner_camera = (T_camera_world_ * corner).cast<float>();
    const Eigen::Matrix3f step = (T_camera_world_.rotation_matrix() * tsdf_.voxel_m).cast<float>();
    for (int i = 0; i < tsdf::kBlockVoxels; ++i) {
      const Eigen::Vector3f row = corner_camera + static_cast<float>((i >> 3) & 7) * step.col(1) +
                                  static_cast<float>(i >> 6) * step.col(2);
      const Eigen::Vector3f along = static_cast<float>(i & 7) * step.col(0);
      observe(row.x() + along.x(), row.y() + along.y(), row.z() + along.z(),
              block[static_cast<std::size_t>(i)]);
    }
  }

 private:
  void observe(float x, float y, float z, tsdf::Voxel& voxel) const {
    if (!(z > 0.0F)) return;
    const float inverse_z = 1.0F / z;
    const float u =
        std::fma(static_cast<float>(camera_.fx_px) * x, inverse_z, static_cast<float>(camera_.cx_px) + 0.5F);
    const float v =
        std::fma(static_cast<float>(camera_.fy_px) * y, inverse_z, static_cast<float>(camera_.cy_px) + 0.5F);
    const DepthImage& depth_m = frame_.depth_m;
    if (!(u >= 0.0F && v >= 0.0F) || !depth_m.contains(static_cast<int>(u), static_cast<int>(v))) return;
    const float measured_m = depth_m(static_cast<int>(u), static_cast<int>(v));
    if (!(measured_m >= static_cast<float>(depth_.min_m) && measured_m <= static_cast<float>(depth_.max_m)))
      return;
    const float from_offset_m = measured_m - static_cast<float>(depth_.noise_offset_m);
    const float sigma_m = std::fma(static_cast<float>(depth_.noise_quadratic_per_m) * from_offset_m,
                                   from_offset_m, static_cast<float>(depth_.noise_floor_m));
    const float band_m = std::max(static_cast<float>(std::max(tsdf_.truncation_m, 2.0 * tsdf_.voxel_m)),
                                  static_cast<float>(tsdf_.truncation_sigmas) * sigma_m);
    const float distance_m = measured_m - z;
    if (distance_m <= -band_m) return;
    const float half_m = 0.5F * band_m;
    const auto variance = static_cast<float>(tsdf_.voxel_m * tsdf_.voxel_m);
    const float weight =
        std::min(half_m, band_m + distance_m) * variance / (half_m * std::fma(sigma_m, sigma_m, variance));
    if (weight < 0x1p-14F) return;
    const float total = voxel.weight + weight;
    const float before_m = voxel.weight > 0.0F ? voxel.distance_m : 0.0F;
    voxel.distance_m =
        as_stored(std::fma(before_m, voxel.weight, std::min(distance_m, band_m) * weight) / total);
    voxel.weight = as_stored(std::min(total, static_cast<float>(tsdf_.max_weight)));
    if (frame_.color.empty() || !(std::abs(distance_m) < half_m)) return;
    add_color(frame_.color(static_cast<int>(u), static_cast<int>(v)), voxel);
  }

  void add_color(const Rgb& observed, tsdf::Voxel& voxel) const {
    const auto count = static_cast<float>(voxel.color_count);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const auto mean = static_cast<float>(voxel.color[channel]);
      const auto target = static_cast<float>(observed[channel]);
      const float moved = std::fma(target - mean, 1.0F / (count + 1.0F), mean);
      voxel.color[channel] = static_cast<std::uint8_t>(moved + color_rounding_);
    }
    const float most = std::min(static_cast<float>(tsdf_.max_weight), 255.0F);
    voxel.color_count = static_cast<std::uint8_t>(std::min(count + 1.0F, most));
  }

  static float as_stored(float value) { return static_cast<float>(simd::Half(value)); }

  const RgbdFrame& frame_;
  const PinholeCamera& camera_;
  SE3 T_camera_world_;
  const config::DepthConfig& depth_;
  const config::TsdfConfig& tsdf_;
  float color_rounding_;
};

}  // namespace fusebench::testing
