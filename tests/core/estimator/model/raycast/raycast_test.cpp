#include "core/estimator/model/raycast/raycast.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/config/groups/frame_config.hpp"
#include "core/config/groups/tsdf_config.hpp"
#include "tests/support/fused_scene.hpp"
#include "tests/support/plain_field.hpp"
#include "tests/support/raycast_image.hpp"

namespace fusebench {

using namespace simd;
using namespace config;
using namespace tsdf;
using namespace raycast;

namespace {

const PinholeCamera kCamera = test_camera(320, 240, 60.0);
const SE3 kOrigin;

struct SceneAgreement {
  int hits = 0;
  int expected = 0;  // pixels that the scene covers at a fair angle
  double mean_depth_m = 0;
  double mean_normal_deg = 0;
  double hit_share = 0;
  int phantoms = 0;  // hits where the scene has nothing within 5 cm
};

// Compares a raycast image with the analytic scene where the surface is seen at less than 70 degrees.
SceneAgreement compare(const testing::SurfaceImage& image, const AnalyticScene& scene,
                       const SE3& T_world_camera) {
  SceneAgreement result;
  const RgbdFrame truth = scene.render(kCamera, T_world_camera, 70.0);
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 0; x < kCamera.width_px; ++x) {
      const double depth_m = image.depth_m(x, y);
      if (depth_m > 0) {
        const Vector3d point = T_world_camera * kCamera.back_project(x, y, depth_m);
        if (std::abs(scene.distance_m(point)) > 0.05) ++result.phantoms;
      }
      if (truth.depth_m(x, y) == 0.0F) continue;
      ++result.expected;
      if (depth_m == 0.0) continue;
      ++result.hits;
      const double true_depth_m = truth.depth_m(x, y);
      result.mean_depth_m += std::abs(depth_m - true_depth_m);
      const Vector3d normal = scene.normal_at(T_world_camera * kCamera.back_project(x, y, true_depth_m));
      const double cosine = normal.dot(image.normal_world(x, y).cast<double>());
      result.mean_normal_deg += std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
    }
  }
  result.mean_depth_m /= result.hits;
  result.mean_normal_deg /= result.hits;
  result.hit_share = static_cast<double>(result.hits) / result.expected;
  return result;
}

TEST(Raycast, EmptyModelGivesNothing) {
  const Workers workers(1);
  const TsdfVolume volume{TsdfConfig{}};
  EXPECT_FALSE(testing::raycast_pixel(volume, kCamera, kOrigin, 10, 20, DepthConfig{}).valid);
  const testing::SurfaceImage image =
      testing::raycast_image(volume, kCamera, kOrigin, DepthConfig{}, workers);
  EXPECT_TRUE(
      std::all_of(image.depth_m.data.begin(), image.depth_m.data.end(), [](float z) { return z == 0.0F; }));
  const SE3 nowhere{Quaterniond::Identity(), Vector3d::Constant(std::nan(""))};
  EXPECT_FALSE(testing::raycast_pixel(volume, kCamera, nowhere, 10, 20, DepthConfig{}).valid);
}

TEST(Raycast, AgreesWithABall) {
  const Workers workers(2);
  const TsdfVolume volume = fuse(ball_scene(), kCamera, poses_around_ball());
  // From a place and a distance that no frame had.
  const SE3 T_world_camera = look_at({0.5, -0.4, 0.55}, {0.02, 0, 0.01});
  const testing::SurfaceImage image =
      testing::raycast_image(volume, kCamera, T_world_camera, DepthConfig{}, workers);
  const SceneAgreement agreement = compare(image, ball_scene(), T_world_camera);
  EXPECT_GT(agreement.expected, 10000);
  EXPECT_EQ(agreement.hits, agreement.expected);
  EXPECT_LT(agreement.mean_depth_m, 0.1 * volume.voxel_m());
  EXPECT_LT(agreement.mean_normal_deg, 2.0);
  EXPECT_EQ(agreement.phantoms, 0);
}

TEST(Raycast, AgreesWithARoomFromInside) {
  const Workers workers(2);
  const TsdfVolume volume = fuse(room_with_a_ball(), kCamera, poses_looking_out({-0.2, 0.1, -0.3}, 40));
  const SE3 T_world_camera = look_at({-0.7, -0.5, -0.6}, {0.5, 0.2, 1.0});
  const testing::SurfaceImage image =
      testing::raycast_image(volume, kCamera, T_world_camera, DepthConfig{}, workers);
  const SceneAgreement agreement = compare(image, room_with_a_ball(), T_world_camera);
  EXPECT_GT(agreement.hit_share, 0.9);  // the ball hides some of the wall from where the frames were taken
  EXPECT_LT(agreement.mean_depth_m, 0.25 * volume.voxel_m());
  EXPECT_LT(agreement.mean_normal_deg, 3.0);
}

TEST(Raycast, RefinesBelowATwentiethOfAVoxel) {
  // The field of a wall across the axis is linear, so the crossing is the wall itself.
  for (const double depth_m : {0.5, 0.7513, 1.0, 1.0049, 1.31}) {
    const AnalyticScene scene{{AnalyticPlane{{0, 0, -1}, -depth_m}}};
    const TsdfVolume volume = fuse(scene, kCamera, {kOrigin});
    for (const double u_px : {10.0, 100.25, 159.5, 300.0}) {
      const SurfacePoint point = testing::raycast_pixel(volume, kCamera, kOrigin, u_px, 77.7, DepthConfig{});
      ASSERT_TRUE(point.valid) << depth_m;
      EXPECT_NEAR(point.depth_m, depth_m, 0.01 * volume.voxel_m());
      EXPECT_LT((point.normal_world - Vector3d(0, 0, -1)).norm(), 1e-4);
    }
  }
}

TEST(Raycast, FindsTheFirstCrossingOfTheTrilinearField) {
  const TsdfVolume volume = fuse(ball_scene(), kCamera, poses_around_ball());
  testing::PlainField field(volume);
  const SE3 T_world_camera = look_at({0.5, -0.4, 0.55}, {0.02, 0, 0.01});
  for (int i = 0; i < 60; ++i) {
    const double u_px = 100.3 + 2.1 * i, v_px = 160.7 - 1.3 * i;
    const SurfacePoint point =
        testing::raycast_pixel(volume, kCamera, T_world_camera, u_px, v_px, DepthConfig{});
    ASSERT_TRUE(point.valid);
    // Reference: tiny steps from 3 cm in front.
    double z_m = point.depth_m - 0.03;
    const auto in_front = [&] {
      const auto distance_m = field.distance_m(T_world_camera * kCamera.back_project(u_px, v_px, z_m));
      return !distance_m || *distance_m >= 0.0;
    };
    while (in_front() && z_m < point.depth_m + 0.03) z_m += 0.00005;
    EXPECT_NEAR(point.depth_m, z_m, 0.05 * volume.voxel_m());
  }
}

TEST(Raycast, LeavesASolidWithoutAHit) {
  const Workers workers(1);
  const TsdfVolume ball = fuse(ball_scene(), kCamera, poses_around_ball());
  DepthConfig depth;
  depth.min_m = 0.0;
  const PinholeCamera coarse = test_camera(64, 48, 90.0);
  for (const SE3& T_world_camera : poses_looking_out({0.02, 0.0, 0.01}, 20)) {
    const testing::SurfaceImage image = testing::raycast_image(ball, coarse, T_world_camera, depth, workers);
    EXPECT_EQ(
        std::count_if(image.depth_m.data.begin(), image.depth_m.data.end(), [](float z) { return z > 0.0F; }),
        0);
  }
  // Out of the band behind a wall, and backwards through the wall.
  const TsdfVolume wall = fuse({{AnalyticPlane{{0, 0, -1}, -1.0}}}, kCamera, {kOrigin});
  for (const double start_z : {1.02, 1.4, 2.0}) {
    EXPECT_FALSE(
        testing::raycast_pixel(wall, kCamera, look_at({0, 0, start_z}, {0.01, 0.02, 0}), 160, 120, depth)
            .valid);
  }
}

TEST(Raycast, SeesTheSurfaceBeyondTheSolidItLeaves) {
  const TsdfVolume volume = fuse(room_with_a_ball(), kCamera, poses_looking_out({-0.2, 0.1, -0.3}, 40));
  // From inside the ball towards the left wall: out through the ball's side that was seen, to the wall.
  const SE3 T_world_camera = look_at({0.35, 0.28, 0.8}, {-1.5, 0.1, -0.4});
  const SurfacePoint point =
      testing::raycast_pixel(volume, kCamera, T_world_camera, kCamera.cx_px, kCamera.cy_px, DepthConfig{});
  ASSERT_TRUE(point.valid);
  EXPECT_GT(point.depth_m, 1.5);
  EXPECT_LT(std::abs(room_with_a_ball().distance_m(T_world_camera * Vector3d(0, 0, point.depth_m))),
            volume.voxel_m());
}

TEST(Raycast, LeavesHolesOpen) {
  const Workers workers(1);
  RgbdFrame frame = AnalyticScene{{AnalyticPlane{{0, 0, -1}, -1.0}}}.render(kCamera, kOrigin);
  for (int y = 80; y < 160; ++y) {
    for (int x = 100; x < 200; ++x) frame.depth_m(x, y) = 0.0F;
  }
  TsdfVolume volume{TsdfConfig{}};
  ASSERT_TRUE(volume.integrate(frame, kCamera, kOrigin, DepthConfig{}, workers));
  const testing::SurfaceImage image =
      testing::raycast_image(volume, kCamera, kOrigin, DepthConfig{}, workers);
  for (int y = 20; y < 220; ++y) {
    for (int x = 20; x < 300; ++x) {
      const bool in_hole = x >= 105 && x < 195 && y >= 85 && y < 155;
      const bool at_rim = !in_hole && x >= 95 && x < 205 && y >= 75 && y < 165;
      if (!at_rim) {
        ASSERT_EQ(image.depth_m(x, y) > 0.0F, !in_hole) << x << ' ' << y;
      }
      if (image.depth_m(x, y) > 0.0F) {
        ASSERT_NEAR(static_cast<double>(image.depth_m(x, y)), 1.0, 1e-3);
      }
    }
  }
}

TEST(Raycast, DoesNotJumpASurfaceThatWasSeenFromTheSide) {
  // At 70 degrees the observed band behind the wall is a third as thick as across: steps of the field's size
  // pass it.
  const AnalyticScene scene{{AnalyticPlane{{0, 0, -1}, 0.0}}};
  const double angle = 70.0 * std::numbers::pi / 180.0;
  const SE3 from_the_side = look_at({1.2 * std::sin(angle), 0, -1.2 * std::cos(angle)}, {0, 0, 0});
  const TsdfVolume volume = fuse(scene, kCamera, {from_the_side});
  int hits = 0, rays = 0;
  for (double start_m = 0.6; start_m < 0.65; start_m += 0.0013) {
    const SE3 across = look_at({0.003, 0.004, -start_m}, {0.003, 0.004, 0});
    const SurfacePoint point =
        testing::raycast_pixel(volume, kCamera, across, kCamera.cx_px, kCamera.cy_px, DepthConfig{});
    ++rays;
    if (!point.valid) continue;
    ++hits;
    EXPECT_NEAR(point.depth_m, start_m, 0.3 * volume.voxel_m());
  }
  EXPECT_EQ(hits, rays);
}

TEST(Raycast, KeepsToTheDepthRange) {
  const TsdfVolume volume = fuse({{AnalyticPlane{{0, 0, -1}, -1.0}}}, kCamera, {kOrigin});
  DepthConfig depth;
  depth.max_m = 0.99;
  EXPECT_FALSE(testing::raycast_pixel(volume, kCamera, kOrigin, 100, 100, depth).valid);
  depth.max_m = 1.06;
  EXPECT_TRUE(testing::raycast_pixel(volume, kCamera, kOrigin, 100, 100, depth).valid);
  depth.min_m = 1.01;
  EXPECT_FALSE(testing::raycast_pixel(volume, kCamera, kOrigin, 100, 100, depth).valid);
}

TEST(Raycast, IsTheSameForEveryWayToCall) {
  const TsdfVolume volume = fuse(ball_scene(), kCamera, poses_around_ball());
  const SE3 T_world_camera = look_at({0.5, -0.4, 0.55}, {0.02, 0, 0.01});
  std::vector<PixelRay> pixels_px;
  for (int y = 0; y < kCamera.height_px; y += 3) {
    for (int x = 0; x < kCamera.width_px; x += 2) pixels_px.push_back(PixelRay{double(x), double(y)});
  }
  std::reverse(pixels_px.begin(), pixels_px.end());
  const testing::SurfaceImage reference =
      testing::raycast_image(volume, kCamera, T_world_camera, DepthConfig{}, Workers(1));
  for (const int threads : {1, 2, 8}) {
    const Workers workers(threads);
    const testing::SurfaceImage image =
        testing::raycast_image(volume, kCamera, T_world_camera, DepthConfig{}, workers);
    EXPECT_EQ(image.depth_m.data, reference.depth_m.data);
    EXPECT_EQ(image.normal_world.data, reference.normal_world.data);
    std::vector<SurfacePoint> points;
    testing::raycast_pixels(volume, kCamera, T_world_camera, pixels_px, DepthConfig{}, workers, points);
    ASSERT_EQ(points.size(), pixels_px.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const float depth_m =
          image.depth_m(static_cast<int>(pixels_px[i].u_px), static_cast<int>(pixels_px[i].v_px));
      ASSERT_EQ(points[i].valid ? static_cast<float>(points[i].depth_m) : 0.0F, depth_m);
    }
  }
}

}  // namespace
}  // namespace fusebench
