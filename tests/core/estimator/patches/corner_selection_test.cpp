#include "core/estimator/patches/corner_selection.hpp"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "core/config/groups/patches_config.hpp"
#include "tests/support/textured_room.hpp"

namespace fusebench {

using namespace config;
using namespace patches;

namespace {

RgbdFrame room_frame() { return testing::TexturedRoom{}.render(testing::small_camera(), SE3{}, 0); }

TEST(CornerSelection, CornersAreSpreadApartInsideAndOnDepth) {
  RgbdFrame frame = room_frame();
  for (int y = 0; y < 240; ++y) {
    for (int x = 200; x < 320; ++x) frame.depth_m(x, y) = 0;  // a hole on the right
  }
  PatchConfig config;
  const std::vector<Eigen::Vector2i> existing{{60, 60}, {150, 100}};
  const auto corners = select_corners(frame.grey, frame.depth_m, existing, config);
  ASSERT_GT(corners.size(), 20U);
  EXPECT_LE(corners.size() + existing.size(), 100U);
  std::vector<Eigen::Vector2i> all = existing;
  for (const Eigen::Vector2i& corner : corners) {
    EXPECT_LT(corner.x(), 200 + config.size_px / 2) << "at least half of the square needs depth";
    EXPECT_TRUE(patch_fits(frame.grey, corner, config.size_px));
    for (const Eigen::Vector2i& other : all) {
      EXPECT_GE((corner - other).squaredNorm(), config.min_distance_px * config.min_distance_px);
    }
    all.push_back(corner);
  }
  // Spread: all quarters of the left part have some.
  std::set<std::pair<int, int>> quarters;
  for (const Eigen::Vector2i& corner : corners) quarters.insert({corner.x() / 100, corner.y() / 120});
  EXPECT_GE(quarters.size(), 4U);
}

TEST(CornerSelection, HonoursTheLimitAndAPlainImage) {
  const RgbdFrame frame = room_frame();
  PatchConfig config;
  config.max_count = 7;
  EXPECT_LE(select_corners(frame.grey, frame.depth_m, {}, config).size(), 7U);
  EXPECT_TRUE(select_corners(GreyImage(320, 240, 77), frame.depth_m, {}, config).empty());
}

TEST(CornerSelection, ASquareKeepsTwoPixelsFromTheBorder) {
  // The square is [c - 5, c + 5).
  const GreyImage grey(64, 48);
  for (const int other : {7, 20}) {
    EXPECT_TRUE(patch_fits(grey, {7, other}, 10));
    EXPECT_FALSE(patch_fits(grey, {6, other}, 10));
    EXPECT_TRUE(patch_fits(grey, {56, other}, 10));
    EXPECT_FALSE(patch_fits(grey, {57, other}, 10));
    EXPECT_TRUE(patch_fits(grey, {other, 7}, 10));
    EXPECT_FALSE(patch_fits(grey, {other, 6}, 10));
    EXPECT_TRUE(patch_fits(grey, {other, 40}, 10));
    EXPECT_FALSE(patch_fits(grey, {other, 41}, 10));
  }
}

}  // namespace
}  // namespace fusebench
