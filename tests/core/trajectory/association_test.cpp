#include "core/trajectory/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <tuple>
#include <utility>

namespace fusebench {

using namespace trajectory;

namespace {

using Stamps = std::vector<std::int64_t>;
using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

Pairs associated(const Stamps& first, const Stamps& second, std::int64_t limit, std::int64_t offset = 0) {
  Pairs pairs;
  for (const AssociatedPair& pair : associate(first, second, limit, offset))
    pairs.emplace_back(pair.first, pair.second);
  return pairs;
}

/// The published rule, word for word: all pairs, sorted, greedily one to one.
Pairs brute_force(const Stamps& first, const Stamps& second, std::int64_t limit) {
  std::vector<std::tuple<std::int64_t, std::int64_t, std::int64_t>> all;
  for (const auto a : first) {
    for (const auto b : second) {
      if (std::abs(a - b) < limit) all.emplace_back(std::abs(a - b), a, b);
    }
  }
  std::sort(all.begin(), all.end());
  Stamps free_first = first;
  Stamps free_second = second;
  Pairs pairs;
  for (const auto& [difference, a, b] : all) {
    const auto in_first = std::find(free_first.begin(), free_first.end(), a);
    const auto in_second = std::find(free_second.begin(), free_second.end(), b);
    if (in_first == free_first.end() || in_second == free_second.end()) continue;
    free_first.erase(in_first);
    free_second.erase(in_second);
    pairs.emplace_back(std::find(first.begin(), first.end(), a) - first.begin(),
                       std::find(second.begin(), second.end(), b) - second.begin());
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(Association, ClosestPairWins) { EXPECT_EQ(associated({0, 10}, {8, 30}, 20), (Pairs{{1, 0}})); }

TEST(Association, LeftOverEntryTakesTheNextBest) {
  EXPECT_EQ(associated({0, 10}, {8, 15}, 20), (Pairs{{0, 1}, {1, 0}}));
}

TEST(Association, EqualDifferencesGoToTheEarlierStamp) {
  EXPECT_EQ(associated({0, 10}, {5}, 20), (Pairs{{0, 0}}));
  EXPECT_EQ(associated({5}, {0, 10}, 20), (Pairs{{0, 0}}));
}

TEST(Association, TheLimitItselfIsTooFar) {
  EXPECT_EQ(associated({0}, {20}, 20), Pairs{});
  EXPECT_EQ(associated({0}, {19}, 20), (Pairs{{0, 0}}));
  EXPECT_EQ(associated({20}, {0}, 20), Pairs{});
}

TEST(Association, TheOffsetMovesTheSecondList) {
  EXPECT_EQ(associated({100}, {0}, 20, 81), (Pairs{{0, 0}}));
  EXPECT_EQ(associated({100}, {0}, 20, 80), Pairs{});
  EXPECT_EQ(associated({100}, {0}, 20, 119), (Pairs{{0, 0}}));
  EXPECT_EQ(associated({100}, {0}, 20, 120), Pairs{});
}

TEST(Association, EmptyLists) {
  EXPECT_EQ(associated({}, {1}, 20), Pairs{});
  EXPECT_EQ(associated({1}, {}, 20), Pairs{});
}

TEST(Association, EqualsThePublishedRuleOnRandomLists) {
  std::mt19937_64 engine(7);
  const auto random_stamps = [&](std::size_t count, std::uint64_t spacing) {
    Stamps stamps;
    std::int64_t time = 0;
    for (std::size_t i = 0; i < count; ++i) {
      // Coarse values make many equal differences; now and then a gap.
      time += 1 + static_cast<std::int64_t>(engine() % spacing);
      if (engine() % 10 == 0) time += 100;
      stamps.push_back(time);
    }
    return stamps;
  };
  std::size_t pairs = 0;
  for (int round = 0; round < 300; ++round) {
    const Stamps first = random_stamps(engine() % 60, 1 + engine() % 30);
    const Stamps second = random_stamps(engine() % 60, 1 + engine() % 30);
    const std::int64_t limit = 1 + static_cast<std::int64_t>(engine() % 40);
    const Pairs expected = brute_force(first, second, limit);
    ASSERT_EQ(associated(first, second, limit), expected) << "round " << round;
    const std::int64_t offset = static_cast<std::int64_t>(engine() % 1000) - 500;
    Stamps moved = second;
    for (std::int64_t& stamp : moved) stamp -= offset;
    ASSERT_EQ(associated(first, moved, limit, offset), expected) << "round " << round;
    pairs += expected.size();
  }
  EXPECT_GT(pairs, 1000U);
}

}  // namespace
}  // namespace fusebench
