#include "core/estimator/model/tsdf/voxel_fusion.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_voxel_update.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace tsdf;

namespace {

using testing::PlainBlock;
using testing::PlainVoxelUpdate;

const PinholeCamera kUpdateCamera = test_camera(160, 120, 60.0);

// A block as the model stores it.
struct StoredBlock {
  StoredBlock() { distance_m.fill(std::numeric_limits<Half>::quiet_NaN()); }
  [[nodiscard]] BlockVoxels view() { return {distance_m.data(), weight.data(), color.data()}; }
  [[nodiscard]] Voxel voxel(std::size_t i) const {
    const auto byte = [&](int number) { return static_cast<std::uint8_t>(color[i] >> (8 * number)); };
    return {static_cast<float>(distance_m[i]),
            static_cast<float>(weight[i]),
            {byte(0), byte(1), byte(2)},
            byte(3)};
  }
  std::array<Half, kBlockVoxels> distance_m;
  std::array<Half, kBlockVoxels> weight{};
  std::array<std::uint32_t, kBlockVoxels> color{};
};

// Depth anywhere between nothing and too far, with damaged pixels among it.
RgbdFrame random_frame(std::mt19937& random) {
  RgbdFrame frame;
  frame.depth_m = DepthImage(kUpdateCamera.width_px, kUpdateCamera.height_px);
  frame.color = ColorImage(kUpdateCamera.width_px, kUpdateCamera.height_px);
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
    const auto frame_number = static_cast<std::uint32_t>(view);
    const SE3 T_world_camera{so3_exp({0.05 * view, -0.1, 0.3 * view}), {0.01 * view, 0.02, -0.03 * view}};
    const VoxelUpdate update(frame, kUpdateCamera, T_world_camera, depth, tsdf, frame_number);
    const PlainVoxelUpdate reference(frame, kUpdateCamera, T_world_camera, depth, tsdf, frame_number);
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

TEST(VoxelUpdate, WhiteStaysWhiteHoweverItIsRounded) {
  RgbdFrame frame;
  frame.depth_m = DepthImage(kUpdateCamera.width_px, kUpdateCamera.height_px, 1.0F);
  frame.color = ColorImage(kUpdateCamera.width_px, kUpdateCamera.height_px, Rgb{255, 255, 255});
  const DepthConfig depth;
  const TsdfConfig tsdf;
  StoredBlock block;
  const BlockIndex before_camera(0, 0, 12);
  // Fibonacci numbers times the golden ratio are nearly whole; above or below by turns.
  for (const std::uint32_t frame_number : {0U, 46368U, 75025U, 150050U}) {
    VoxelUpdate(frame, kUpdateCamera, SE3{}, depth, tsdf, frame_number).apply(before_camera, block.view());
    const Voxel voxel = block.voxel(offset_in_block({1, 1, 4}));
    EXPECT_EQ(voxel.color, (Rgb{255, 255, 255})) << frame_number;
    EXPECT_GT(voxel.color_count, 0) << frame_number;
  }
}

}  // namespace
}  // namespace fusebench
