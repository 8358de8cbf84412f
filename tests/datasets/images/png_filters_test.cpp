// The vector instructions of the filters against their definition, a byte at a time.
#include "datasets/images/png_filters.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>
#include <vector>

namespace fusebench {

using namespace images;

namespace {

using Bytes = std::vector<std::uint8_t>;

/// PNG specification, section 9.
Bytes by_definition(int filter, const Bytes& filtered, const Bytes& above, std::size_t pixel_bytes) {
  Bytes row;
  for (std::size_t i = 0; i < filtered.size(); ++i) {
    const int a = i >= pixel_bytes ? row[i - pixel_bytes] : 0;
    const int b = above[i];
    const int c = i >= pixel_bytes ? above[i - pixel_bytes] : 0;
    const int p = a + b - c;
    const bool left = std::abs(p - a) <= std::abs(p - b) && std::abs(p - a) <= std::abs(p - c);
    const int paeth = left ? a : std::abs(p - b) <= std::abs(p - c) ? b : c;
    const std::array<int, 5> predictions = {0, a, b, (a + b) / 2, paeth};
    row.push_back(static_cast<std::uint8_t>(filtered[i] + predictions[static_cast<std::size_t>(filter)]));
  }
  return row;
}

/// Few values make ties, of which Paeth's filter has many kinds; all values make sums that wrap.
Bytes random_bytes(std::size_t count, std::mt19937& random) {
  const std::array<std::uint32_t, 3> ranges = {3, 20, 256};
  const std::uint32_t range = ranges[random() % ranges.size()];
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random() % range);
  return bytes;
}

template <std::size_t kPixelBytes>
void expect_definition(std::size_t width) {
  std::mt19937 random(static_cast<std::uint32_t>(width));
  for (int filter = 0; filter < 5; ++filter) {
    for (int repetition = 0; repetition < 9; ++repetition) {
      const Bytes filtered = random_bytes(width * kPixelBytes, random);
      const Bytes above = random_bytes(width * kPixelBytes, random);
      Bytes row(width * kPixelBytes);
      ASSERT_TRUE(undo_png_filter<kPixelBytes>(filter, filtered, above, row));
      ASSERT_EQ(row, by_definition(filter, filtered, above, kPixelBytes)) << filter << ", width " << width;
    }
  }
}

// The last pixels of a row are fewer than a vector holds, from none to all but one.
TEST(PngFilters, FollowTheirDefinitionAtAnyWidth) {
  for (std::size_t width = 1; width <= 50; ++width) {
    expect_definition<2>(width);
    expect_definition<3>(width);
  }
  expect_definition<2>(640);
  expect_definition<3>(1919);
}

TEST(PngFilters, WriteNothingBeyondTheRow) {
  std::mt19937 random(1);
  for (std::size_t width = 1; width <= 20; ++width) {
    const Bytes filtered = random_bytes(3 * width, random);
    for (int filter = 0; filter < 5; ++filter) {
      Bytes rows(3 * width + 32, 77);
      ASSERT_TRUE(undo_png_filter<3>(filter, filtered, filtered, std::span(rows).first(3 * width)));
      for (std::size_t i = 3 * width; i < rows.size(); ++i) ASSERT_EQ(rows[i], 77) << filter << " " << width;
    }
  }
}

TEST(PngFilters, ThereAreFive) {
  const Bytes filtered(6);
  Bytes row(6);
  for (const int filter : {-1, 5, 255}) {
    EXPECT_FALSE(undo_png_filter<2>(filter, filtered, filtered, row));
    EXPECT_FALSE(undo_png_filter<3>(filter, filtered, filtered, row));
  }
}

}  // namespace
}  // namespace fusebench
