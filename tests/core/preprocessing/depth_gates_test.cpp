#include "core/preprocessing/depth_gates.hpp"

#include <gtest/gtest.h>

#include "tests/support/gated_depth.hpp"

namespace fusebench {

using namespace config;
using namespace preprocessing;

namespace {

TEST(DepthGates, RangeAndEdgesBecomeHolesAndPlanesStay) {
  DepthImage depth(20, 20, 1.0F);
  for (int y = 0; y < 20; ++y) {
    for (int x = 10; x < 20; ++x) depth(x, y) = 1.5F;
  }
  depth(3, 3) = 0.1F;
  depth(16, 16) = 9.0F;
  const DepthImage gated = testing::gated_depth(depth, DepthConfig{});
  EXPECT_EQ(gated(3, 3), 0.0F);
  EXPECT_EQ(gated(16, 16), 0.0F);
  EXPECT_EQ(gated(9, 10), 0.0F) << "near side of the edge";
  EXPECT_EQ(gated(10, 10), 0.0F) << "far side of the edge";
  EXPECT_EQ(gated(7, 10), 1.0F);
  EXPECT_EQ(gated(13, 10), 1.5F);
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
