#include "core/estimator/places/ferns/color_fern_code.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench {

using namespace ferns;

namespace {

struct Scene {
  ColorImage color;
  DepthImage depth_m;
};

/// Coloured waves and a slanted wall; `shift_px` moves both sideways, `phase` makes another place of it.
Scene scene(double phase, double shift_px = 0, double light = 1) {
  Scene result{ColorImage(320, 240), DepthImage(320, 240)};
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const double u = x + shift_px;
      const auto channel = [&](double a, double b, double c) {
        const double value = 110 + 60 * std::sin(u * a + phase) * std::cos(y * b + c * phase);
        return static_cast<std::uint8_t>(light * value);
      };
      result.color(x, y) = {channel(0.03, 0.05, 1), channel(0.05, 0.02, 2), channel(0.02, 0.04, 3)};
      result.depth_m(x, y) = static_cast<float>(1.5 + 0.004 * u + 0.8 * std::sin(0.02 * y + phase));
    }
  }
  return result;
}

/// Smeared along x, as a camera that turns does.
ColorImage blurred(const ColorImage& sharp, int length_px) {
  ColorImage result = sharp;
  for (int y = 0; y < sharp.height; ++y) {
    for (int x = 0; x < sharp.width; ++x) {
      std::array<int, 3> sums{};
      for (int k = 0; k < length_px; ++k) {
        for (std::size_t c = 0; c < 3; ++c) sums[c] += sharp(std::min(x + k, sharp.width - 1), y)[c];
      }
      for (std::size_t c = 0; c < 3; ++c) result(x, y)[c] = static_cast<std::uint8_t>(sums[c] / length_px);
    }
  }
  return result;
}

FernCode code_of(const Scene& s) { return color_fern_code(s.color, s.depth_m); }

TEST(ColorFernCode, TheSameImageHasTheSameCode) {
  EXPECT_EQ(code_of(scene(0.3)), code_of(scene(0.3)));
  EXPECT_EQ(dissimilarity(code_of(scene(0.3)), code_of(scene(0.3))), 0);
}

TEST(ColorFernCode, BrightnessDropsOut) {
  EXPECT_LT(dissimilarity(code_of(scene(0.3)), code_of(scene(0.3, 0, 0.6))), 0.05);
}

TEST(ColorFernCode, BlurAndASmallMotionChangeItLessThanAnotherPlace) {
  const FernCode here = code_of(scene(0.3));
  Scene smeared = scene(0.3);
  smeared.color = blurred(smeared.color, 12);
  const double by_blur = dissimilarity(here, code_of(smeared));
  const double by_motion = dissimilarity(here, code_of(scene(0.3, 8)));
  const double by_place = dissimilarity(here, code_of(scene(1.9)));
  EXPECT_LT(by_blur, 0.6 * by_place);
  EXPECT_LT(by_motion, 0.8 * by_place);
}

TEST(ColorFernCode, MissingDepthIsNoError) {
  Scene dark = scene(0.3);
  std::ranges::fill(dark.depth_m.data, 0.0F);
  EXPECT_GT(dissimilarity(code_of(dark), code_of(scene(0.3))), 0);
}

}  // namespace
}  // namespace fusebench
