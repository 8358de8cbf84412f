#include "core/base/trajectory/association.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
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
  std::vector<std::tuple<std::int64_t, std::size_t, std::size_t>> all;
  for (std::size_t a = 0; a < first.size(); ++a) {
    for (std::size_t b = 0; b < second.size(); ++b) {
      if (std::abs(first[a] - second[b]) < limit) all.emplace_back(std::abs(first[a] - second[b]), a, b);
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<bool> first_used(first.size());
  std::vector<bool> second_used(second.size());
  Pairs pairs;
  for (const auto& [difference, a, b] : all) {
    if (first_used[a] || second_used[b]) continue;
    first_used[a] = second_used[b] = true;
    pairs.emplace_back(a, b);
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

/// Sorted stamps whose distances are below `spacing`; now and then a gap. Coarse values make many equal
/// differences, a least step of 0 equal stamps.
Stamps random_stamps(std::mt19937_64& engine, std::size_t count, std::uint64_t spacing,
                     std::int64_t least_step) {
  Stamps stamps;
  std::int64_t time = 0;
  for (std::size_t i = 0; i < count; ++i) {
    time += least_step + static_cast<std::int64_t>(engine() % spacing);
    if (engine() % 10 == 0) time += 100;
    stamps.push_back(time);
  }
  return stamps;
}

TEST(Association, EqualsThePublishedRuleOnRandomLists) {
  std::mt19937_64 engine(7);
  for (const std::int64_t least_step : {1, 0}) {
    std::size_t pairs = 0;
    for (int round = 0; round < 1000; ++round) {
      const Stamps first = random_stamps(engine, engine() % 60, 1 + engine() % 30, least_step);
      const Stamps second = random_stamps(engine, engine() % 60, 1 + engine() % 30, least_step);
      const std::int64_t limit = static_cast<std::int64_t>(engine() % 200);
      const Pairs expected = brute_force(first, second, limit);
      ASSERT_EQ(associated(first, second, limit), expected) << "round " << round;
      const std::int64_t offset = static_cast<std::int64_t>(engine() % 1000) - 500;
      Stamps moved = second;
      for (std::int64_t& stamp : moved) stamp -= offset;
      ASSERT_EQ(associated(first, moved, limit, offset), expected) << "round " << round;
      pairs += expected.size();
    }
    EXPECT_GT(pairs, 5000U);
  }
}

TEST(Association, EqualStampsArePairedInTheirOrder) {
  EXPECT_EQ(associated({5, 5, 5}, {5, 5}, 1), (Pairs{{0, 0}, {1, 1}}));
  EXPECT_EQ(associated({5, 5}, {4, 6, 6}, 2), (Pairs{{0, 0}, {1, 1}}));
}

// All pairs within the limit would be 4e10, or a terabyte.
TEST(Association, TakesDenseListsWithoutAListOfAllPairs) {
  constexpr std::size_t kCount = 200'000;
  Stamps first, second;
  for (std::size_t i = 0; i < kCount; ++i) {
    first.push_back(3 * static_cast<std::int64_t>(i));
    second.push_back(3 * static_cast<std::int64_t>(i) + 1);
  }
  const auto pairs = associate(first, second, 20'000'000);
  ASSERT_EQ(pairs.size(), kCount);
  for (std::size_t i = 0; i < kCount; ++i) EXPECT_TRUE(pairs[i].first == i && pairs[i].second == i) << i;
}

TEST(Association, HoldsAtTheEndsOfWhatStampsCanBe) {
  constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(associated({kLeast, 0, kMost}, {kLeast + 1, kMost - 1}, kMost), (Pairs{{0, 0}, {2, 1}}));
  EXPECT_EQ(associated({0}, {kMost - 1}, kMost), (Pairs{{0, 0}}));
  EXPECT_EQ(associated({kLeast}, {kMost}, kMost), Pairs{});
  EXPECT_EQ(associated({kMost}, {kMost}, 20, -5), (Pairs{{0, 0}})) << "a sum that does not fit is clamped";
  EXPECT_EQ(associated({0}, {0}, 0), Pairs{});
  EXPECT_EQ(associated({0}, {0}, -1), Pairs{});
}

}  // namespace
}  // namespace fusebench
