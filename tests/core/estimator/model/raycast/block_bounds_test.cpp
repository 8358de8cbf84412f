#include "core/estimator/model/raycast/block_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_field.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace tsdf;
using namespace raycast;

namespace {

const PinholeCamera kBoundsCamera = test_camera(160, 120, 60.0);

float bound_m(const BlockBounds& bounds, double u_px, double v_px) {
  return bounds.nearest_m(all_lanes(static_cast<float>(u_px)), all_lanes(static_cast<float>(v_px)))[0];
}

TEST(BlockBounds, NoRayMeetsTheModelBefore) {
  const TsdfVolume volume = fuse(ball_scene(), kBoundsCamera, poses_around_ball());
  testing::PlainField field(volume);
  const DepthConfig depth;
  int seen = 0;
  for (const SE3& T_world_camera :
       {look_at({0.5, -0.4, 0.55}, {0.02, 0, 0.01}), look_at({0, 0.2, -1.5}, {0, 0, 0})}) {
    const BlockBounds bounds(volume, kBoundsCamera, T_world_camera, depth);
    // The walk along whole rays, from the very front, in steps of a quarter of a voxel.
    for (int y = 0; y < kBoundsCamera.height_px; y += 7) {
      for (int x = 0; x < kBoundsCamera.width_px; x += 7) {
        const Vector3d ray = kBoundsCamera.back_project(x, y, 1.0);
        double first_m = std::numeric_limits<double>::infinity();
        for (double z_m = depth.min_m; z_m < depth.max_m; z_m += 0.25 * volume.voxel_m()) {
          if (!field.distance_m(T_world_camera * Vector3d(z_m * ray))) continue;
          first_m = z_m;
          break;
        }
        EXPECT_LE(bound_m(bounds, x, y), first_m + 1e-6) << x << ", " << y;
        seen += std::isfinite(first_m) ? 1 : 0;
      }
    }
  }
  EXPECT_GT(seen, 50);
}

TEST(BlockBounds, AreCloseToTheSurface) {
  const double wall_m = 2.0;
  const AnalyticScene wall{{AnalyticPlane{{0, 0, -1}, -wall_m, {10, 120, 250}}}};
  const TsdfVolume volume = fuse(wall, kBoundsCamera, {SE3{}});
  const BlockBounds bounds(volume, kBoundsCamera, SE3{}, DepthConfig{});
  for (int x = 20; x < 140; x += 10) {
    EXPECT_LE(bound_m(bounds, x, 60), wall_m);
    EXPECT_GT(bound_m(bounds, x, 60), wall_m - 0.3) << "a block, the band, and the sphere around the block";
  }
}

/// Uses the few blocks of one pixel, whose neighbours cannot hide a missing bound.
TEST(BlockBounds, NoCornerOfABlockLiesBefore) {
  const PinholeCamera camera = test_camera(640, 480, 90.0);
  const DepthConfig depth;
  int corners = 0;
  for (int column = 5; column < 640; column += 9) {
    RgbdFrame frame;
    frame.depth_m = DepthImage(640, 480, 0.0F);
    for (int y = 230; y < 234; ++y) {
      for (int x = column; x < column + 4 && x < 640; ++x) frame.depth_m(x, y) = 0.5F;
    }
    TsdfVolume volume{TsdfConfig{}};
    ASSERT_TRUE(volume.integrate(frame, camera, SE3{}, depth, Workers(1)));
    const BlockBounds bounds(volume, camera, SE3{}, depth);
    for (const BlockIndex& block : volume.block_indices()) {
      for (int n = 0; n < 8; ++n) {
        const BlockIndex corner = block + BlockIndex(n & 1, (n >> 1) & 1, n >> 2);
        const Vector3d point = corner.cast<double>() * (kBlockSide * volume.voxel_m());
        const Vector2d pixel = camera.project(point);
        if (point.z() < depth.min_m || !frame.depth_m.contains(static_cast<int>(std::floor(pixel.x())),
                                                               static_cast<int>(std::floor(pixel.y()))))
          continue;
        if (pixel.x() > 639 || pixel.y() > 479) continue;
        EXPECT_LE(bound_m(bounds, pixel.x(), pixel.y()), point.z() + 1e-6) << pixel.transpose();
        ++corners;
      }
    }
  }
  EXPECT_GT(corners, 500);
}

TEST(BlockBounds, AreZeroOutsideOfTheImageAndInfiniteWithoutBlocks) {
  const AnalyticScene wall{{AnalyticPlane{{0, 0, -1}, -2.0, {10, 120, 250}}}};
  const TsdfVolume volume = fuse(wall, kBoundsCamera, {SE3{}});
  const BlockBounds ahead(volume, kBoundsCamera, SE3{}, DepthConfig{});
  EXPECT_EQ(bound_m(ahead, -1, 60), 0.0F);
  EXPECT_EQ(bound_m(ahead, 160, 60), 0.0F);
  EXPECT_EQ(bound_m(ahead, 80, 120), 0.0F);
  const SE3 away{so3_exp({0, 3.14, 0}), Vector3d::Zero()};
  const BlockBounds behind(volume, kBoundsCamera, away, DepthConfig{});
  EXPECT_EQ(bound_m(behind, 80, 60), std::numeric_limits<float>::infinity());
  DepthConfig near;
  near.max_m = 1.0;
  const BlockBounds too_far(volume, kBoundsCamera, SE3{}, near);
  EXPECT_EQ(bound_m(too_far, 80, 60), std::numeric_limits<float>::infinity());
}

}  // namespace
}  // namespace fusebench
