#include "core/estimator/places/ferns/depth_fern_code.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench {

using namespace ferns;

namespace {

/// A slanted wall with a wave; `shift_px` moves it sideways, `phase` makes another place of it.
DepthImage wall(double phase, double shift_px = 0, int step = 1) {
  DepthImage depth_m(320 / step, 240 / step);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      const double u = step * x + shift_px;
      depth_m(x, y) =
          static_cast<float>(1.8 + 0.003 * u + 0.9 * std::sin(0.02 * step * y + phase + 0.01 * phase * u));
    }
  }
  return depth_m;
}

TEST(DepthFernCode, CodesAreSimilarForTheSamePlaceOnly) {
  const FernCode code = depth_fern_code(wall(0.5));
  EXPECT_EQ(dissimilarity(code, depth_fern_code(wall(0.5))), 0);
  EXPECT_LT(dissimilarity(code, depth_fern_code(wall(0.5, 8))), 0.3);
  EXPECT_GT(dissimilarity(code, depth_fern_code(wall(3.5))), 0.5);
}

TEST(DepthFernCode, TheSizeOfTheImageHardlyMatters) {
  EXPECT_LT(dissimilarity(depth_fern_code(wall(0.5)), depth_fern_code(wall(0.5, 0, 2))), 0.1);
  EXPECT_LT(dissimilarity(depth_fern_code(wall(0.5)), depth_fern_code(wall(0.5, 0, 8))), 0.4)
      << "smaller than what ferns ask about";
}

TEST(DepthFernCode, PixelsWithoutDepthDoNotCount) {
  DepthImage with_holes = wall(0.5);
  for (int y = 0; y < with_holes.height; ++y) {
    for (int x = y % 2; x < with_holes.width; x += 2) with_holes(x, y) = 0;
  }
  EXPECT_LT(dissimilarity(depth_fern_code(wall(0.5)), depth_fern_code(with_holes)), 0.1);
}

}  // namespace
}  // namespace fusebench
