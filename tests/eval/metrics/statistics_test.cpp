#include "eval/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace fusebench {

using namespace metrics;

namespace {

TEST(Statistics, ByHandOddCount) {
  const std::array values = {3.0, 1.0, 2.0};
  const Statistics s = statistics(values);
  EXPECT_EQ(s.count, 3U);
  EXPECT_DOUBLE_EQ(s.sse, 14.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(14.0 / 3.0));
  EXPECT_DOUBLE_EQ(s.mean, 2.0);
  EXPECT_DOUBLE_EQ(s.median, 2.0);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(2.0 / 3.0));  // ddof 0
  EXPECT_EQ(s.min, 1.0);
  EXPECT_EQ(s.max, 3.0);
}

TEST(Statistics, MedianOfAnEvenCountIsBetweenTheMiddleTwo) {
  const std::array values = {10.0, 1.0, 4.0, 2.0};
  EXPECT_DOUBLE_EQ(statistics(values).median, 3.0);
}

TEST(Statistics, StandardDeviationSurvivesALargeMean) {
  const std::array values = {1e9 + 1, 1e9 + 2, 1e9 + 3};
  EXPECT_NEAR(statistics(values).std, std::sqrt(2.0 / 3.0), 1e-9);
}

TEST(Statistics, NoValuesGiveNoNumbers) {
  const Statistics s = statistics({});
  EXPECT_EQ(s.count, 0U);
  EXPECT_TRUE(std::isnan(s.rmse));
  EXPECT_TRUE(std::isnan(s.mean));
}

}  // namespace
}  // namespace fusebench
