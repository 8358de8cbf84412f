#include "core/estimator/places/ferns/depth_fern_code.hpp"

#include <array>
#include <random>

#include "core/estimator/places/ferns/cell_means.hpp"

namespace fusebench::ferns {

namespace {

constexpr std::uint64_t kSeed = 20261126;

struct DepthTest {
  int x = 0;
  int y = 0;
  float threshold_m = 0;
};
using DepthTests = std::array<DepthTest, kFerns * kTestsOfFern>;

DepthTests make_tests() {
  std::mt19937_64 generator(kSeed);
  DepthTests tests;
  for (DepthTest& test : tests) {
    test.x = static_cast<int>(uniform(generator) * kWidth);
    test.y = static_cast<int>(uniform(generator) * kHeight);
    test.threshold_m = static_cast<float>(kNearest_m + kReach_m * uniform(generator));
  }
  return tests;
}

}  // namespace

FernCode depth_fern_code(const DepthImage& depth_m) {
  static const DepthTests tests = make_tests();
  const Image<float> means_m = mean_depth_m(depth_m);
  FernCode code{};
  for (std::size_t i = 0; i < tests.size(); ++i) {
    if (means_m(tests[i].x, tests[i].y) >= tests[i].threshold_m) pass(code, i);
  }
  return code;
}

}  // namespace fusebench::ferns
