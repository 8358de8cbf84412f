#include "core/estimator/patches/posed_camera.hpp"

#include <gtest/gtest.h>

#include "core/base/image.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace patches;

namespace {

TEST(PosedCamera, ComposesTheTransforms) {
  const SE3 T_imu_camera{so3_exp({0.02, -0.03, 1.5}), {0.09, 0.003, 0.002}};
  const SE3 T_world_imu{so3_exp({0.1, 0.2, -1.4}), {0.05, -0.1, 0.02}};
  const PosedCamera posed(testing::small_camera(), T_world_imu, T_imu_camera);
  const Vector3d point_world(0.4, -0.3, 2.0);
  const Vector3d point_camera = (T_world_imu * T_imu_camera).inverse() * point_world;
  EXPECT_LT((posed.to_camera(point_world) - point_camera).norm(), 1e-14);
  EXPECT_LT((posed.to_imu(point_camera) - T_world_imu.inverse() * point_world).norm(), 1e-14);
}

TEST(PosedCamera, LevelsShareTheirPixelGrid) {
  // Pixel (x, y) of level l is (x, y) * 2^l of level 0, for odd sizes as well.
  PinholeCamera camera = testing::small_camera();
  camera.width_px = 321;
  const PinholeCamera level2 = camera_at_level(camera, 2);
  const Vector3d point(0.3, -0.2, 1.7);
  EXPECT_LT((4.0 * level2.project(point) - camera.project(point)).norm(), 1e-12);
  const auto pyramid = build_pyramid(GreyImage(321, 240, 9), 3);
  EXPECT_EQ(pyramid[2].width, level2.width_px);
  EXPECT_EQ(pyramid[2].height, level2.height_px);
  EXPECT_EQ(pyramid[2](40, 30), 9);
}

}  // namespace
}  // namespace fusebench
