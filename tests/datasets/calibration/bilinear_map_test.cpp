#include "datasets/calibration/bilinear_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/error.hpp"

namespace fusebench {

using namespace calibration;

namespace {

using Position = std::array<int, 2>;  ///< x, y in 1/32 pixels

ColorImage random_image(int width, int height) {
  std::mt19937 random(7);
  ColorImage image(width, height);
  for (Rgb& pixel : image.data) {
    // Extremes are where rounding and overflows show.
    for (std::uint8_t& channel : pixel)
      channel = static_cast<std::uint8_t>(random() % 3 == 0 ? 255 * (random() % 2) : random());
  }
  return image;
}

/// The mean of four pixels, weighted by the areas opposite to them; beyond the border there is more of it.
Rgb interpolated(const ColorImage& image, Position at) {
  const auto floor_32 = [](int value) { return static_cast<int>(std::floor(value / 32.0)); };
  const int x = floor_32(at[0]);
  const int y = floor_32(at[1]);
  const int u = at[0] - 32 * x;
  const int v = at[1] - 32 * y;
  const auto pixel = [&](int i, int j) {
    return image(std::clamp(i, 0, image.width - 1), std::clamp(j, 0, image.height - 1));
  };
  Rgb result;
  for (std::size_t c = 0; c < result.size(); ++c) {
    const int sum = (32 - u) * (32 - v) * pixel(x, y)[c] + u * (32 - v) * pixel(x + 1, y)[c] +
                    (32 - u) * v * pixel(x, y + 1)[c] + u * v * pixel(x + 1, y + 1)[c];
    result[c] = static_cast<std::uint8_t>((sum + 512) / 1024);
  }
  return result;
}

void expect_interpolation(const ColorImage& image, const std::vector<Position>& sources) {
  BilinearMap map(image.width, image.height);
  for (const Position& source : sources) map.add(source[0], source[1]);
  const ColorImage result = map.apply(image);
  for (std::size_t i = 0; i < sources.size(); ++i)
    ASSERT_EQ(result.data[i], interpolated(image, sources[i]))
        << image.width << "x" << image.height << ", pixel " << i;
}

TEST(BilinearMap, InterpolatesAnywhere) {
  std::mt19937 random(1);
  for (const auto& [width, height] : {std::array{64, 48}, {1, 1}, {1, 9}, {9, 1}, {2, 2}, {7, 5}, {33, 3}}) {
    const ColorImage image = random_image(width, height);
    std::vector<Position> sources(image.data.size());
    const auto anywhere = [&](int size_px) {
      return static_cast<int>(random() % static_cast<unsigned>(32 * (size_px + 4))) - 64;
    };
    for (Position& source : sources) source = {anywhere(width), anywhere(height)};
    expect_interpolation(image, sources);
  }
}

// Runs of all lengths, as a lens makes them: what is done many bytes at once, and where runs and image end.
TEST(BilinearMap, InterpolatesRuns) {
  std::mt19937 random(2);
  for (const auto& [width, height] : {std::array{97, 41}, {31, 7}, {5, 300}}) {
    const ColorImage image = random_image(width, height);
    for (const int step : {2, 7, 40, 100000}) {
      std::vector<Position> sources;
      Position moved = {0, 0};
      for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
          if (random() % static_cast<unsigned>(step) == 0)
            moved = {static_cast<int>(random() % 200) - 100, static_cast<int>(random() % 200) - 100};
          const int jitter = static_cast<int>(random() % 4);
          sources.push_back({32 * x + moved[0] + jitter, 32 * y + moved[1] - jitter});
        }
      }
      expect_interpolation(image, sources);
    }
  }
}

TEST(BilinearMap, AWholePixelIsTakenAsItIs) {
  const ColorImage image = random_image(50, 20);
  BilinearMap map(50, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 50; ++x) map.add(32 * x, 32 * y);
  }
  EXPECT_EQ(map.apply(image).data, image.data);
}

TEST(BilinearMap, IsForImagesOfItsSize) {
  BilinearMap map(2, 1);
  map.add(0, 0);
  EXPECT_ANY_THROW(static_cast<void>(map.apply(ColorImage(2, 1)))) << "a pixel without a source";
  map.add(0, 0);
  EXPECT_NO_THROW(static_cast<void>(map.apply(ColorImage(2, 1))));
  EXPECT_ANY_THROW(static_cast<void>(map.apply(ColorImage(1, 2))));
  EXPECT_ANY_THROW(static_cast<void>(BilinearMap().apply(ColorImage(2, 1))));
}

}  // namespace
}  // namespace fusebench
