#include "eval/compare/rank_test.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace fusebench {

using namespace compare;

namespace {

TEST(RankTestTest, KnownExactProbabilities) {
  const std::vector<double> low5 = {1, 2, 3, 4, 5};
  const std::vector<double> high5 = {6, 7, 8, 9, 10};
  const RankTest apart = test_larger(low5, high5);
  EXPECT_TRUE(apart.exact);
  EXPECT_DOUBLE_EQ(apart.u, 25);
  EXPECT_DOUBLE_EQ(apart.p, 1.0 / 252);
  EXPECT_DOUBLE_EQ(test_larger(high5, low5).p, 1);
  // Of the 20 sets of three ranks of six, {2, 5, 6}, {3, 4, 6}, {3, 5, 6} and {4, 5, 6} have a sum of 13 or
  // more.
  EXPECT_DOUBLE_EQ(test_larger(std::vector<double>{1, 3, 4}, std::vector<double>{2, 5, 6}).p, 4.0 / 20);
  EXPECT_DOUBLE_EQ(test_larger(std::vector<double>{1}, std::vector<double>{2}).p, 0.5);
  EXPECT_DOUBLE_EQ(least_p(5), 1.0 / 252);
  EXPECT_NEAR(least_p(7), 1.0 / 3432, 1e-15);
}

TEST(RankTestTest, CriticalValuesOfTheUsualTables) {
  // One-sided 1 % for 5 and 5 is U <= 1, for 7 and 7 U <= 6: the last one below, the next one not.
  const std::vector<double> a = {1, 2, 3, 4, 6};
  EXPECT_LT(test_larger(a, std::vector<double>{5, 7, 8, 9, 10}).p, 0.01);  // U' = 1
  EXPECT_GT(test_larger(std::vector<double>{1, 2, 3, 4, 7}, std::vector<double>{5, 6, 8, 9, 10}).p,
            0.01);  // U' = 2
  const std::vector<double> seven = {1, 2, 3, 4, 5, 6, 13};
  const RankTest six = test_larger(seven, std::vector<double>{7, 8, 9, 10, 11, 12, 14});  // U' = 6
  EXPECT_DOUBLE_EQ(six.u, 43);
  EXPECT_LT(six.p, 0.01);
  const RankTest seventh = test_larger(std::vector<double>{1, 2, 3, 4, 5, 7, 13},
                                       std::vector<double>{6, 8, 9, 10, 11, 12, 14});  // U' = 7
  EXPECT_GT(seventh.p, 0.01);
}

TEST(RankTestTest, TiesTakeTheNormalApproximation) {
  const std::vector<double> a = {1, 1, 2, 2, 3};
  const std::vector<double> b = {2, 3, 3, 4, 4};
  const RankTest test = test_larger(a, b);
  EXPECT_FALSE(test.exact);
  // U: 5 + 3 * 2 ... by hand: 2: 2 + 0.5 * 2 = 3; each 3: 4.5; each 4: 5. Together 22.
  EXPECT_DOUBLE_EQ(test.u, 22);
  // Variance 25 / 12 * (11 - (6 + 24 + 24 + 6) / 90) = 21.5278; z = (22 - 12.5 - 0.5) / 4.6398 = 1.93974.
  EXPECT_NEAR(test.p, 0.026206, 1e-4);
  EXPECT_DOUBLE_EQ(test_larger(std::vector<double>(9, 1.0), std::vector<double>(9, 1.0)).p, 1);
  EXPECT_DOUBLE_EQ(test_larger({}, a).p, 1);
}

TEST(RankTestTest, LargeGroupsAgreeWithTheExactDistribution) {
  std::mt19937_64 generator(7);
  std::vector<double> a;
  std::vector<double> b;
  const auto uniform = [&] { return static_cast<double>(generator() >> 11) * 0x1p-53; };
  for (int i = 0; i < 20; ++i) {
    a.push_back(uniform());
    b.push_back(uniform() + 0.2);
  }
  const RankTest exact = test_larger(a, b);
  ASSERT_TRUE(exact.exact);
  b.push_back(b.back() + 1e-12);
  const RankTest normal = test_larger(a, b);
  ASSERT_FALSE(normal.exact);
  EXPECT_NEAR(exact.p, normal.p, 0.01);
  // Both directions of the exact test share the probability of the u itself.
  const RankTest reversed = test_larger(std::vector<double>(b.begin(), b.end() - 1), a);
  EXPECT_GT(exact.p + reversed.p, 1);
  EXPECT_LT(exact.p + reversed.p, 1.1);
}

TEST(RankTestTest, EqualDistributionsFireAsOftenAsAlphaSays) {
  std::mt19937_64 generator(1);
  int below = 0;
  constexpr int kTrials = 4000;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> a(7);
    std::vector<double> b(7);
    for (double& value : a) value = static_cast<double>(generator() >> 11);
    for (double& value : b) value = static_cast<double>(generator() >> 11);
    if (test_larger(a, b).p < 0.05) ++below;
  }
  EXPECT_LT(below, kTrials * 0.06);
  EXPECT_GT(below, kTrials * 0.03);
}

}  // namespace
}  // namespace fusebench
