#include "core/ferns/color_fern_code.hpp"

#include <algorithm>
#include <array>
#include <random>

#include "core/base/error.hpp"

namespace fusebench::ferns {

namespace {

constexpr int kWidth = 80;
constexpr int kHeight = 60;
constexpr std::size_t kChannels = kTestsOfFern;  // red, green, blue, depth
constexpr double kMeanGrey = 110;                // that colour is scaled to
constexpr std::uint64_t kSeed = 20261125;

struct FernTest {
  int x = 0;
  int y = 0;
  float threshold = 0;
};
using FernTests = std::array<FernTest, kFerns * kChannels>;

FernTests make_tests() {
  std::mt19937_64 generator(kSeed);
  FernTests tests;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i].x = static_cast<int>(uniform(generator) * kWidth);
    tests[i].y = static_cast<int>(uniform(generator) * kHeight);
    const bool depth = i % kChannels == kChannels - 1;
    tests[i].threshold = static_cast<float>(depth ? 0.4 + 3.6 * uniform(generator)   // metres
                                                  : 20 + 215 * uniform(generator));  // grey levels
  }
  return tests;
}

using Channels = std::array<Image<float>, kChannels>;

/// The pixels of a cell of the small image: first and one past the last.
struct Cells {
  int begin;
  int end;
};
Cells cells_of(int index, int count, int size) { return {index * size / count, (index + 1) * size / count}; }

/// Means of the cells; of depth those of the pixels that have some.
Channels small_image(const ColorImage& color, const DepthImage& depth_m) {
  Channels channels;
  channels.fill(Image<float>(kWidth, kHeight));
  for (int y = 0; y < kHeight; ++y) {
    const Cells rows = cells_of(y, kHeight, color.height);
    for (int x = 0; x < kWidth; ++x) {
      const Cells columns = cells_of(x, kWidth, color.width);
      std::array<double, kChannels> sums{};
      int measured = 0;
      for (int v = rows.begin; v < rows.end; ++v) {
        for (int u = columns.begin; u < columns.end; ++u) {
          for (std::size_t c = 0; c < 3; ++c) sums[c] += color(u, v)[c];
          sums[3] += static_cast<double>(depth_m(u, v));
          measured += depth_m(u, v) > 0 ? 1 : 0;
        }
      }
      const double pixels = (rows.end - rows.begin) * (columns.end - columns.begin);
      for (std::size_t c = 0; c < 3; ++c) channels[c](x, y) = static_cast<float>(sums[c] / pixels);
      channels[3](x, y) = measured > 0 ? static_cast<float>(sums[3] / measured) : 0.0F;
    }
  }
  return channels;
}

void normalise_brightness(Channels& channels) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    for (const float value : channels[c].data) sum += static_cast<double>(value);
  }
  const auto factor = static_cast<float>(kMeanGrey / std::max(sum / (3.0 * kWidth * kHeight), 1.0));
  for (std::size_t c = 0; c < 3; ++c) {
    for (float& value : channels[c].data) value *= factor;
  }
}

}  // namespace

FernCode color_fern_code(const ColorImage& color, const DepthImage& depth_m) {
  check(color.width >= kWidth && color.height >= kHeight && depth_m.width == color.width &&
            depth_m.height == color.height,
        "colour and depth have one size, at least 80x60");
  static const FernTests tests = make_tests();
  Channels channels = small_image(color, depth_m);
  normalise_brightness(channels);
  FernCode code{};
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (channels[i % kChannels](tests[i].x, tests[i].y) >= tests[i].threshold) pass(code, i);
  }
  return code;
}

}  // namespace fusebench::ferns
