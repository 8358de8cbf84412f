#include "core/depth_gates.hpp"

#include <gtest/gtest.h>

#include "tests/support/textured_room.hpp"

namespace fusebench {
namespace {

TEST(DepthGates, RangeAndEdgesBecomeHolesAndPlanesStay) {
  DepthImage depth(20, 20, 1.0F);
  for (int y = 0; y < 20; ++y) {
    for (int x = 10; x < 20; ++x) depth(x, y) = 1.5F;
  }
  depth(3, 3) = 0.1F;
  depth(16, 16) = 9.0F;
  const DepthImage gated = gate_depth(depth, DepthConfig{});
  EXPECT_EQ(gated(3, 3), 0.0F);
  EXPECT_EQ(gated(16, 16), 0.0F);
  EXPECT_EQ(gated(9, 10), 0.0F) << "near side of the edge";
  EXPECT_EQ(gated(10, 10), 0.0F) << "far side of the edge";
  EXPECT_EQ(gated(7, 10), 1.0F);
  EXPECT_EQ(gated(13, 10), 1.5F);
}

TEST(DepthGates, NormalOfASlantedPlaneFacesTheCamera) {
  const PinholeCamera camera = testing::small_camera();
  const Vector3d normal = Vector3d(0.4, -0.2, -1.0).normalized();
  DepthImage depth(320, 240);
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      depth(x, y) = static_cast<float>(normal.z() * 2.0 / normal.dot(camera.back_project(x, y, 1.0)));
    }
  }
  EXPECT_LT((measured_normal(depth, camera, 200, 90) - normal).norm(), 1e-4);
  EXPECT_EQ(measured_normal(depth, camera, 2, 90).norm(), 0.0) << "no neighbours at the border";
  depth(204, 90) = 0;
  EXPECT_EQ(measured_normal(depth, camera, 200, 90).norm(), 0.0) << "a missing neighbour";
}

TEST(DepthGates, OneSurfaceReachesAsFarAsNoJumpAndNoHoleIsNear) {
  constexpr double kJump = 0.03;
  DepthImage depth(40, 40, 1.0F);
  for (int y = 0; y < 40; ++y) {
    for (int x = 20; x < 40; ++x) depth(x, y) = 1.05F;
  }
  for (const int reach_px : {1, 2, 4}) {
    EXPECT_TRUE(is_one_surface(depth, 19 - reach_px, 10, reach_px, kJump)) << reach_px;
    EXPECT_FALSE(is_one_surface(depth, 20 - reach_px, 10, reach_px, kJump)) << reach_px;
    EXPECT_FALSE(is_one_surface(depth, 19 + reach_px, 10, reach_px, kJump)) << reach_px;
    EXPECT_TRUE(is_one_surface(depth, 20 + reach_px, 10, reach_px, kJump)) << reach_px;
  }
  EXPECT_TRUE(is_one_surface(depth, 19, 10, 0, kJump)) << "without reach the pixel is alone";
  EXPECT_TRUE(is_one_surface(depth, 19, 10, 4, 0.06)) << "a smaller step than is a jump";
  EXPECT_TRUE(is_one_surface(depth, 0, 0, 4, kJump)) << "what lies outside does not count";
  depth(14, 14) = 0;
  EXPECT_FALSE(is_one_surface(depth, 10, 10, 4, kJump)) << "a hole where the pixel reaches";
  EXPECT_FALSE(is_one_surface(depth, 14, 14, 0, kJump));
  EXPECT_TRUE(is_one_surface(depth, 10, 10, 2, kJump));
}

}  // namespace
}  // namespace fusebench
