#include "core/base/simd/lanes.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "core/base/simd/image_lanes.hpp"

namespace fusebench {

using namespace simd;

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr Float8 kAbsurd = {kNaN, -kNaN, kInfinity, -kInfinity, 1e30F, -1e30F, 4.0F, 2e9F};

TEST(Lanes, ClampedValuesAreWithinTheBoundsWhateverTheyWere) {
  const Float8 clamped = clamp(kAbsurd, 1.0F, 6.0F);
  const Float8 expected = {1.0F, 1.0F, 6.0F, 1.0F, 6.0F, 1.0F, 4.0F, 6.0F};
  for (std::size_t lane = 0; lane < kLanes; ++lane) EXPECT_EQ(clamped[lane], expected[lane]) << lane;
}

TEST(Lanes, AClampedPlaceIsInItsImage) {
  GreyImage image(8, 8);
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::uint8_t>(i);
  const Float8 x = clamp(kAbsurd, 1.0F, 6.0F);
  const Float8 grey = sample_bicubic_value(image, x, x);
  const Float8 linear = sample_bilinear_value(image, x, x);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    EXPECT_FLOAT_EQ(grey[lane], 9.0F * x[lane]) << lane;
    EXPECT_FLOAT_EQ(linear[lane], 9.0F * x[lane]) << lane;
  }
}

}  // namespace
}  // namespace fusebench
