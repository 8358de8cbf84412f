// Stamps are multiples of 1/8 s, so that their differences in seconds are exact.
#include "eval/metrics/trajectory_files/nearest_association.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace fusebench {

using namespace trajectory_files;

namespace {

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
using Eighths = std::vector<int>;

std::vector<std::int64_t> stamps_ns(const Eighths& eighths) {
  std::vector<std::int64_t> stamps;
  for (const int count : eighths) stamps.push_back(std::int64_t{125'000'000} * count);
  return stamps;
}

Pairs nearest(const Eighths& first, const Eighths& second, double limit_s, double offset_s = 0) {
  Pairs pairs;
  for (const auto& pair : associate_nearest(stamps_ns(first), stamps_ns(second), limit_s, offset_s))
    pairs.emplace_back(pair.first, pair.second);
  return pairs;
}

TEST(NearestAssociation, TakesTheFirstEntryOfTwoAsNear) {
  EXPECT_EQ(nearest({0, 2, 8}, {1}, 1.0), (Pairs{{0, 0}}));
  EXPECT_EQ(nearest({1}, {0, 2, 8}, 1.0), (Pairs{{0, 0}}));
  // Entries count in the order of the list, not of time.
  EXPECT_EQ(nearest({2, 0, 8}, {1}, 1.0), (Pairs{{0, 0}}));
  EXPECT_EQ(nearest({1}, {2, 0, 8}, 1.0), (Pairs{{0, 0}}));
  EXPECT_EQ(nearest({8, 0, 0, 2}, {1}, 1.0), (Pairs{{1, 0}}));
}

TEST(NearestAssociation, IncludesTheLimit) {
  EXPECT_EQ(nearest({2}, {0}, 0.25), (Pairs{{0, 0}}));
  EXPECT_EQ(nearest({2}, {0}, 0.2499), Pairs{});
}

TEST(NearestAssociation, AddsTheOffsetToTheSecondList) {
  EXPECT_EQ(nearest({8}, {0}, 0.125, 1.0), (Pairs{{0, 0}}));
  EXPECT_EQ(nearest({8}, {0}, 0.125, -1.0), Pairs{});
  EXPECT_EQ(nearest({8}, {0, 80}, 0.125, 1.0), (Pairs{{0, 0}}));
}

/// evo's rule, word for word: the shorter list drives, argmin of the differences, the limit included.
Pairs brute_force(const Eighths& first, const Eighths& second, int limit) {
  const bool first_drives = first.size() < second.size();
  const Eighths& driving = first_drives ? first : second;
  const Eighths& longer = first_drives ? second : first;
  Pairs pairs;
  for (std::size_t k = 0; k < driving.size(); ++k) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < longer.size(); ++i) {
      if (std::abs(longer[i] - driving[k]) < std::abs(longer[best] - driving[k])) best = i;
    }
    if (longer.empty() || std::abs(longer[best] - driving[k]) > limit) continue;
    pairs.emplace_back(first_drives ? k : best, first_drives ? best : k);
  }
  return pairs;
}

TEST(NearestAssociation, EqualsEvosRuleOnRandomLists) {
  std::mt19937 random(11);
  for (int round = 0; round < 500; ++round) {
    const auto list = [&] {
      Eighths eighths(1 + random() % 12);
      for (int& count : eighths) count = static_cast<int>(random() % 40);
      return eighths;
    };
    const Eighths first = list();
    const Eighths second = list();
    ASSERT_EQ(nearest(first, second, 3 * 0.125), brute_force(first, second, 3)) << "round " << round;
  }
}

}  // namespace
}  // namespace fusebench
