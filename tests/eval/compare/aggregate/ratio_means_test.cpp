#include "eval/compare/aggregate/ratio_means.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench {

using namespace aggregate;

namespace {

TEST(RatioMeans, AreGeometricMeansOfRatiosToTheBestOfEachRecording) {
  const auto means = ratio_means({{{0.01}, {0.02}}, {{0.9}, {0.3}}, {{0.5}, {0.5}}});
  ASSERT_EQ(means.size(), 2U);
  EXPECT_NEAR(*means[0].ratio, std::cbrt(1.0 * 3.0 * 1.0), 1e-12);
  EXPECT_NEAR(*means[1].ratio, std::cbrt(2.0 * 1.0 * 1.0), 1e-12);
  EXPECT_TRUE(means[0].tied) << "each is the better one of a recording";
  EXPECT_TRUE(means[1].tied);
}

TEST(RatioMeans, AClearDifferenceIsNoTieAndItsIntervalContainsTheMean) {
  ReplicatedValues values;
  for (int i = 0; i < 8; ++i) {
    const double scale = std::pow(3.0, i);
    values.push_back({{scale, 1.02 * scale}, {1.5 * scale, (1.6 + 0.02 * i) * scale}});
  }
  const auto means = ratio_means(values);
  EXPECT_TRUE(means[0].tied);
  EXPECT_FALSE(means[1].tied);
  const auto& [low, high] = means[1].interval.value();
  EXPECT_LT(low, *means[1].ratio);
  EXPECT_GT(high, *means[1].ratio);
  EXPECT_GT(low, 1.4);
  EXPECT_LT(high, 1.8);
  EXPECT_EQ(ratio_means(values)[1].interval, means[1].interval) << "the seed is fixed";
}

TEST(RatioMeans, OneRecordingHasAnIntervalOnlyByItsReplicates) {
  EXPECT_FALSE(ratio_means({{{1.0}, {2.0}}})[1].interval);
  EXPECT_FALSE(ratio_means({{{1.0}, {2.0}}})[1].tied);
  EXPECT_TRUE(ratio_means({{{1.0}, {1.0}}})[1].tied);
  const auto noisy = ratio_means({{{1.0, 1.4, 1.2}, {1.1, 1.5, 1.3}}});
  EXPECT_TRUE(noisy[1].interval.has_value());
  EXPECT_TRUE(noisy[1].tied) << "their ranges overlap";
}

TEST(RatioMeans, AConfigurationWithFewerRecordingsIsNeverTied) {
  const auto means = ratio_means({{{1.0}, {0.5}}, {{1.0}, {}}});
  EXPECT_EQ(means[1].recordings, 1U);
  EXPECT_TRUE(means[0].tied);
  EXPECT_FALSE(means[1].tied);
  EXPECT_NEAR(*means[0].ratio, std::sqrt(2.0), 1e-12);
}

TEST(RatioMeans, NumbersThatAreNotPositiveHaveNoRatio) {
  for (const RatioMean& mean : ratio_means({{{0.0}, {1.0}}})) EXPECT_FALSE(mean.ratio);
  EXPECT_TRUE(ratio_means({}).empty());
}

}  // namespace
}  // namespace fusebench
