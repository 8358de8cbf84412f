#include "core/voxel_update.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "core/depth_gates.hpp"
#include "tests/support/fused_scene.hpp"

namespace fusebench {
namespace {

const PinholeCamera kCamera = test_camera(160, 120, 60.0);

// A block as the model stores it.
struct StoredBlock {
  StoredBlock() { distance_m.fill(std::numeric_limits<float>::quiet_NaN()); }
  [[nodiscard]] BlockVoxels view() {
    return {distance_m.data(),
            weight.data(),
            {color[0].data(), color[1].data(), color[2].data()},
            color_count.data()};
  }
  [[nodiscard]] Voxel voxel(std::size_t i) const {
    return {distance_m[i], weight[i], {color[0][i], color[1][i], color[2][i]}, color_count[i]};
  }
  std::array<float, kBlockVoxels> distance_m;
  std::array<float, kBlockVoxels> weight{};
  std::array<std::array<std::uint16_t, kBlockVoxels>, 3> color{};
  std::array<std::uint16_t, kBlockVoxels> color_count{};
};

// One voxel after the other, by the same formulas: what the eight lanes of a row must agree with to the bit.
using PlainBlock = std::array<Voxel, kBlockVoxels>;

class PlainUpdate {
 public:
  PlainUpdate(const RgbdFrame& frame, const SE3& T_world_camera, const DepthConfig& depth,
              const TsdfConfig& tsdf)
      : frame_(frame), T_camera_world_(T_world_camera.inverse()), depth_(depth), tsdf_(tsdf) {}

  void apply(const BlockIndex& index, PlainBlock& block) const {
    const Vector3d corner = index.cast<double>() * (kBlockSide * tsdf_.voxel_m);
    const Eigen::Vector3f corner_camera = (T_camera_world_ * corner).cast<float>();
    const Eigen::Matrix3f step = (T_camera_world_.rotation_matrix() * tsdf_.voxel_m).cast<float>();
    for (int i = 0; i < kBlockVoxels; ++i) {
      const Eigen::Vector3f row = corner_camera + static_cast<float>((i >> 3) & 7) * step.col(1) +
                                  static_cast<float>(i >> 6) * step.col(2);
      const Eigen::Vector3f along = static_cast<float>(i & 7) * step.col(0);
      observe(row.x() + along.x(), row.y() + along.y(), row.z() + along.z(),
              block[static_cast<std::size_t>(i)]);
    }
  }

 private:
  void observe(float x, float y, float z, Voxel& voxel) const {
    if (!(z > 0.0F)) return;
    const float inverse_z = 1.0F / z;
    const float u =
        static_cast<float>(kCamera.fx_px) * x * inverse_z + static_cast<float>(kCamera.cx_px) + 0.5F;
    const float v =
        static_cast<float>(kCamera.fy_px) * y * inverse_z + static_cast<float>(kCamera.cy_px) + 0.5F;
    const DepthImage& depth_m = frame_.depth_m;
    if (!(u >= 0.0F && v >= 0.0F) || !depth_m.contains(static_cast<int>(u), static_cast<int>(v))) return;
    const float measured_m = depth_m(static_cast<int>(u), static_cast<int>(v));
    if (!(measured_m >= static_cast<float>(depth_.min_m) && measured_m <= static_cast<float>(depth_.max_m)))
      return;
    const float from_offset_m = measured_m - static_cast<float>(depth_.noise_offset_m);
    const float sigma_m = static_cast<float>(depth_.noise_floor_m) +
                          static_cast<float>(depth_.noise_quadratic_per_m) * from_offset_m * from_offset_m;
    const float band_m = std::max(static_cast<float>(std::max(tsdf_.truncation_m, 2.0 * tsdf_.voxel_m)),
                                  static_cast<float>(tsdf_.truncation_sigmas) * sigma_m);
    const float distance_m = measured_m - z;
    if (distance_m <= -band_m) return;
    const float half_m = 0.5F * band_m;
    const auto variance = static_cast<float>(tsdf_.voxel_m * tsdf_.voxel_m);
    const float weight =
        std::min(half_m, band_m + distance_m) * variance / (half_m * (variance + sigma_m * sigma_m));
    const float total = voxel.weight + weight;
    const float before_m = voxel.weight > 0.0F ? voxel.distance_m : 0.0F;
    voxel.distance_m = (before_m * voxel.weight + std::min(distance_m, band_m) * weight) / total;
    voxel.weight = std::min(total, static_cast<float>(tsdf_.max_weight));
    if (frame_.color.empty() || !(std::abs(distance_m) < half_m)) return;
    const Rgb& observed = frame_.color(static_cast<int>(u), static_cast<int>(v));
    const auto count = static_cast<float>(voxel.color_count);
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const auto mean = static_cast<float>(voxel.color[channel]);
      const float target = 256.0F * static_cast<float>(observed[channel]);
      voxel.color[channel] =
          static_cast<std::uint16_t>(mean + (target - mean) * (1.0F / (count + 1.0F)) + 0.5F);
    }
    const float most = std::min(static_cast<float>(tsdf_.max_weight), 255.0F);
    voxel.color_count = static_cast<std::uint16_t>(std::min(count + 1.0F, most));
  }

  const RgbdFrame& frame_;
  SE3 T_camera_world_;
  const DepthConfig& depth_;
  const TsdfConfig& tsdf_;
};

// Depth anywhere between nothing and too far, with damaged pixels among it.
RgbdFrame random_frame(std::mt19937& random) {
  RgbdFrame frame;
  frame.depth_m = DepthImage(kCamera.width_px, kCamera.height_px);
  frame.color = ColorImage(kCamera.width_px, kCamera.height_px);
  std::uniform_real_distribution<float> depth_m(0.2F, 1.4F);
  std::uniform_int_distribution<int> level(0, 255);
  for (float& z : frame.depth_m.data) {
    const int kind = level(random);
    z = kind < 20 ? 0.0F : kind < 25 ? std::numeric_limits<float>::quiet_NaN() : depth_m(random);
  }
  for (Rgb& color : frame.color.data) {
    for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(level(random));
  }
  return frame;
}

TEST(VoxelUpdate, EightVoxelsAtOnceAreTheSameBitsAsOneByOne) {
  std::mt19937 random(7);
  const DepthConfig depth{.min_m = 0.3, .max_m = 1.3};
  const TsdfConfig tsdf{.max_weight = 3.5};  // saturates soon, and the colour's count with a fraction
  // Blocks in view, across the border of the image, around and behind the camera.
  std::vector<BlockIndex> indices;
  for (int i = 0; i < 40; ++i) indices.emplace_back(i % 10 - 5, i % 7 - 3, i / 2 - 2);
  std::vector<StoredBlock> blocks(indices.size());
  std::vector<PlainBlock> plain(indices.size());
  for (int view = 0; view < 6; ++view) {
    const RgbdFrame frame = random_frame(random);
    const SE3 T_world_camera{so3_exp({0.05 * view, -0.1, 0.3 * view}), {0.01 * view, 0.02, -0.03 * view}};
    const VoxelUpdate update(frame, kCamera, T_world_camera, depth, tsdf);
    const PlainUpdate reference(frame, T_world_camera, depth, tsdf);
    for (std::size_t i = 0; i < indices.size(); ++i) {
      update.apply(indices[i], blocks[i].view());
      reference.apply(indices[i], plain[i]);
    }
  }
  int observed = 0;
  int colored = 0;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    for (std::size_t v = 0; v < plain[i].size(); ++v) {
      const Voxel& voxel = plain[i][v];
      const Voxel stored = blocks[i].voxel(v);
      ASSERT_EQ(std::memcmp(&stored, &voxel, sizeof(Voxel)), 0) << "block " << i << ", voxel " << v;
      observed += voxel.weight > 0.0F ? 1 : 0;
      colored += voxel.color_count > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(observed, 2000);
  EXPECT_GT(colored, 500);
  EXPECT_LT(colored, observed);
}

}  // namespace
}  // namespace fusebench
