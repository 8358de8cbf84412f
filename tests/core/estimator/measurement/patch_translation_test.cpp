#include "core/estimator/measurement/patch_translation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/simd/image_lanes.hpp"

namespace fusebench {

using namespace measurement;
using namespace patches;

namespace {

constexpr int kSide = 16;

/// A smooth texture, or one that does not change along y.
GreyImage texture(bool varies_along_y) {
  GreyImage image(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const double along_y = varies_along_y ? std::cos(0.4 * y + 0.1 * x) : 0.0;
      image(x, y) = static_cast<std::uint8_t>(std::lround(128 + 50 * std::sin(0.35 * x) + 50 * along_y));
    }
  }
  return image;
}

/// The pixels of a square at (24, 24), as they are in the image, and placed there.
struct Square {
  explicit Square(const GreyImage& image) {
    for (int i = 0; i < kSide * kSide; i += static_cast<int>(simd::kLanes)) {
      PixelLanes& reference = pixels.emplace_back();
      WarpedLanes& w = warped.emplace_back();
      for (std::size_t lane = 0; lane < simd::kLanes; ++lane) {
        const int at = i + static_cast<int>(lane);
        const int x = 24 + at % kSide;
        const int y = 24 + at / kSide;
        reference.intensity[lane] = image(x, y);
        w.x[lane] = static_cast<float>(x);
        w.y[lane] = static_cast<float>(y);
        w.in_image[lane] = w.visible[lane] = -1;
      }
    }
  }
  std::vector<PixelLanes> pixels;
  std::vector<WarpedLanes> warped;
};

TEST(PatchTranslation, RecoversAKnownShift) {
  const GreyImage image = texture(true);
  Square square(image);
  const Vector2d off_px(1.7, -2.3);
  translate(square.warped, off_px, image);
  const std::vector<PlacedPatch> levels = {{square.pixels, square.warped, image}};
  EXPECT_LT((own_translation_px(levels) + off_px).norm(), 0.02);
}

TEST(PatchTranslation, APixelOfACoarseLevelIsAsWideAsItsLevel) {
  // Only level 4 has texture: a translation by a pixel of it is one by 16 pixels.
  const GreyImage image = texture(true);
  Square square(image);
  translate(square.warped, {1.0, -0.5}, image);
  const GreyImage flat(64, 64, 128);
  const Square plain(flat);
  std::vector<PlacedPatch> levels(4, PlacedPatch{plain.pixels, plain.warped, flat});
  levels.push_back({square.pixels, square.warped, image});
  EXPECT_LT((own_translation_px(levels) + 16.0 * Vector2d(1.0, -0.5)).norm(), 0.5);
}

TEST(PatchTranslation, AnEdgeDoesNotMoveAPatchAlongItself) {
  const GreyImage image = texture(false);
  Square square(image);
  translate(square.warped, {1.2, 0.0}, image);
  const std::vector<PlacedPatch> levels = {{square.pixels, square.warped, image}};
  EXPECT_EQ(own_translation_px(levels), Vector2d::Zero());
}

TEST(PatchTranslation, PixelsThatLeaveTheImageAreNotVisible) {
  const GreyImage image = texture(true);
  Square square(image);
  translate(square.warped, {27.5, 0.0}, image);  // columns 51.5 to 66.5 of 64
  for (const WarpedLanes& w : square.warped) {
    for (std::size_t lane = 0; lane < simd::kLanes; ++lane)
      EXPECT_EQ(w.visible[lane] != 0, w.x[lane] <= 62.0F) << w.x[lane];
  }
}

}  // namespace
}  // namespace fusebench
