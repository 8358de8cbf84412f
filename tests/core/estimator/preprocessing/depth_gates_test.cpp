#include "core/estimator/preprocessing/depth_gates.hpp"

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

TEST(DepthGates, AJumpToAnyOfTheEightNeighboursIsAnEdge) {
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      if (dx == 0 && dy == 0) continue;
      for (const float neighbour_m : {0.96F, 0.98F, 1.02F, 1.04F}) {
        DepthImage depth(24, 24, 1.0F);
        depth(10 + dx, 10 + dy) = neighbour_m;
        const bool edge = neighbour_m < 0.97F || neighbour_m > 1.03F;
        EXPECT_EQ(testing::gated_depth(depth, DepthConfig{.edge_jump = 0.03})(10, 10), edge ? 0.0F : 1.0F)
            << dx << ", " << dy << ": " << neighbour_m;
      }
      DepthImage hole(24, 24, 1.0F);
      hole(10 + dx, 10 + dy) = 0.0F;
      EXPECT_EQ(testing::gated_depth(hole, DepthConfig{})(10, 10), 1.0F) << "missing depth is no edge";
    }
  }
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
