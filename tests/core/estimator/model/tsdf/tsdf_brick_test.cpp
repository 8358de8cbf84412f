#include "core/estimator/model/tsdf/tsdf_brick.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/estimator/model/tsdf/tsdf_lanes.hpp"
#include "tests/support/fused_scene.hpp"

namespace fusebench {

using namespace simd;
using namespace tsdf;

namespace {

/// Both NaN, or the same.
void expect_same(Float8 a, Float8 b) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    EXPECT_TRUE(a[lane] == b[lane] || (std::isnan(a[lane]) && std::isnan(b[lane])))
        << a[lane] << " " << b[lane];
  }
}

Points minus(const Points& p, const Vector3d& offset) {
  return {p.x - static_cast<float>(offset.x()), p.y - static_cast<float>(offset.y()),
          p.z - static_cast<float>(offset.z())};
}

TEST(TsdfBrick, GivesTheBytesOfTheVolumeInside) {
  const TsdfVolume volume = fuse(ball_scene(), test_camera(320, 240, 60.0), poses_around_ball());
  const TsdfLanes lanes(volume, Vector3d::Zero(), 1.0);
  TsdfBrick brick;
  // Around a part of the surface with seen and unseen voxels; twice, the second box smaller than the first.
  for (const VoxelIndex& last : {VoxelIndex(38, 21, 19), VoxelIndex(33, 11, 9)}) {
    const VoxelIndex first(22, -9, -13);
    brick.copy(volume, first, last);
    std::mt19937 random(3);
    int observed = 0;
    for (int i = 0; i < 300; ++i) {
      Points at_voxel{};  // sixteenths, which coordinates from either origin hold exactly
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const auto draw = [&](int low, int high) {
          return static_cast<float>(std::uniform_int_distribution<int>(16 * low, 16 * high - 1)(random)) / 16;
        };
        at_voxel.x[lane] = draw(first.x() + 1, last.x() - 1);
        at_voxel.y[lane] = draw(first.y() + 1, last.y() - 1);
        at_voxel.z[lane] = draw(first.z() + 1, last.z() - 1);
      }
      const Points in_brick = minus(at_voxel, brick.origin_voxel().cast<double>());
      const Points in_lanes = minus(at_voxel, lanes.origin_voxel());
      const Float8 distance_m = brick.sample(in_brick);
      expect_same(distance_m, lanes.sample(in_lanes));
      const Points a = brick.gradient(in_brick);
      const Points b = lanes.gradient(in_lanes);
      expect_same(a.x, b.x);
      expect_same(a.y, b.y);
      expect_same(a.z, b.z);
      observed += std::isnan(distance_m[0]) ? 0 : 1;
    }
    EXPECT_GT(observed, 30);
    EXPECT_LT(observed, 300);
  }
}

TEST(TsdfBrick, IsUnobservedOutside) {
  const TsdfVolume volume = fuse(ball_scene(), test_camera(320, 240, 60.0), poses_around_ball());
  TsdfBrick brick;
  brick.copy(volume, {24, 0, 0}, {39, 7, 7});
  const auto at = [](float x, float y, float z) { return Points{all_lanes(x), all_lanes(y), all_lanes(z)}; };
  EXPECT_FALSE(std::isnan(brick.sample(at(7.5F, 3.5F, 3.5F))[0]));
  for (const Points& outside :
       {at(-0.5F, 3, 3), at(15.5F, 3, 3), at(7, -0.1F, 3), at(7, 7.1F, 3), at(7, 3, 7.1F)}) {
    EXPECT_TRUE(std::isnan(brick.sample(outside)[0]));
  }
  // The gradient needs one voxel more.
  EXPECT_TRUE(std::isnan(brick.gradient(at(7.5F, 0.5F, 3.5F)).x[0]));
  EXPECT_TRUE(std::isnan(brick.gradient(at(7.5F, 3.5F, 6.5F)).x[0]));
}

}  // namespace
}  // namespace fusebench
