#include "core/estimator/places/ferns/color_fern_code.hpp"

#include <algorithm>
#include <array>
#include <random>

#include "core/base/error.hpp"
#include "core/estimator/places/ferns/cell_means.hpp"

namespace fusebench::ferns {

namespace {

constexpr std::size_t kChannels = kTestsOfFern;  // red, green, blue, depth
constexpr double kMeanGrey = 110;                // mean to which colour is scaled
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
    tests[i].threshold = static_cast<float>(depth ? kNearest_m + kReach_m * uniform(generator)
                                                  : 20 + 215 * uniform(generator));  // grey levels
  }
  return tests;
}

using Channels = std::array<Image<float>, kChannels>;

Channels small_image(const ColorImage& color, const DepthImage& depth_m) {
  Channels channels;
  channels.fill(Image<float>(kWidth, kHeight));
  for (int y = 0; y < kHeight; ++y) {
    const Cells rows = cells_of(y, kHeight, color.height);
    for (int x = 0; x < kWidth; ++x) {
      const Cells columns = cells_of(x, kWidth, color.width);
      std::array<double, 3> sums{};
      for (int v = rows.begin; v < rows.end; ++v) {
        for (int u = columns.begin; u < columns.end; ++u) {
          for (std::size_t c = 0; c < 3; ++c) sums[c] += color(u, v)[c];
        }
      }
      const double pixels = (rows.end - rows.begin) * (columns.end - columns.begin);
      for (std::size_t c = 0; c < 3; ++c) channels[c](x, y) = static_cast<float>(sums[c] / pixels);
    }
  }
  channels[3] = mean_depth_m(depth_m);
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
