#include "core/estimator/places/ferns/fern_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace fusebench {

using namespace ferns;

namespace {

TEST(FernCode, DissimilarityIsTheShareOfFernsNotOfTests) {
  FernCode code{};
  EXPECT_EQ(dissimilarity(code, FernCode{}), 0);
  pass(code, 0);
  pass(code, 1);
  EXPECT_DOUBLE_EQ(dissimilarity(code, FernCode{}), 1.0 / kFerns);  // two tests of one fern
  pass(code, kTestsOfFern);
  EXPECT_DOUBLE_EQ(dissimilarity(code, FernCode{}), 2.0 / kFerns);
  FernCode opposite{};
  for (std::size_t test = 0; test < kFerns * kTestsOfFern; ++test) pass(opposite, test);
  EXPECT_EQ(dissimilarity(FernCode{}, opposite), 1);
}

TEST(FernCode, UniformNumbersFillTheUnitIntervalAndAreTheSameEverywhere) {
  std::mt19937_64 generator(5489);
  // The standard gives the first output of this generator with its default seed: 14514284786278117030.
  EXPECT_DOUBLE_EQ(uniform(generator), 14514284786278117030.0 / 18446744073709551616.0);
  double sum = 0, least = 1, largest = 0;
  constexpr int kDraws = 10000;
  for (int i = 0; i < kDraws; ++i) {
    const double value = uniform(generator);
    sum += value;
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.02);
  EXPECT_GE(least, 0);
  EXPECT_LT(least, 0.01);
  EXPECT_LT(largest, 1);
  EXPECT_GT(largest, 0.99);
}

}  // namespace
}  // namespace fusebench
