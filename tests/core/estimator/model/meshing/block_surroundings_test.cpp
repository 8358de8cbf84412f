// Against single lookups in the volume.
#include "core/estimator/model/meshing/block_surroundings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "core/estimator/model/tsdf/block_slots.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_field.hpp"

namespace fusebench {

using namespace simd;
using namespace tsdf;
using namespace meshing;

namespace {

const PinholeCamera kCamera = test_camera(320, 240, 60.0);

TEST(BlockSlots, AreThoseOfTheVolume) {
  const TsdfVolume volume = fuse(ball_scene(), kCamera, poses_around_ball());
  BlockSlots slots(volume);
  int found = 0;
  for (int z = -7; z < 7; ++z) {
    for (int y = -7; y < 7; ++y) {
      for (int x = -7; x < 7; ++x) {
        const BlockIndex index(x, y, z);
        EXPECT_EQ(slots.find(index), volume.find_block(index)) << index.transpose();
        found += slots.find(index) >= 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(found, 100);
  const BlockIndex far(1 << 27, -(1 << 27), 5);
  EXPECT_EQ(slots.find(far), -1);
}

TEST(BlockSurroundings, HoldTheVoxelsInAndAroundABlock) {
  const TsdfVolume volume = fuse(ball_scene(), kCamera, poses_around_ball());
  BlockSurroundings surroundings(volume);
  std::size_t observed = 0;
  std::size_t colored = 0;
  for (std::size_t slot = 0; slot < volume.block_count(); slot += 17) {
    const BlockIndex block = volume.block_indices()[slot];
    surroundings.load(block);
    for (int z = -1; z < kBlockSide + 2; ++z) {
      for (int y = -1; y < kBlockSide + 2; ++y) {
        for (int x = -1; x < kBlockSide + 2; ++x) {
          const VoxelIndex local(x, y, z);
          const Voxel voxel = testing::find_voxel(volume, block * kBlockSide + local).value_or(Voxel{});
          const float distance_m = surroundings.distance_m(local);
          ASSERT_TRUE(distance_m == voxel.distance_m ||
                      (std::isnan(distance_m) && std::isnan(voxel.distance_m)));
          const std::uint32_t color = surroundings.color(local);
          ASSERT_EQ(color >> 24, voxel.color_count);
          ASSERT_EQ(color & 0xFF, voxel.color[0]);
          ASSERT_EQ(color >> 16 & 0xFF, voxel.color[2]);
          observed += std::isnan(distance_m) ? 0U : 1U;
          colored += voxel.color_count > 0 ? 1U : 0U;
        }
      }
    }
  }
  EXPECT_GT(observed, 1000U);
  EXPECT_GT(colored, 100U);
}

}  // namespace
}  // namespace fusebench
