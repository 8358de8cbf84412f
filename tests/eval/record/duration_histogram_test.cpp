#include "eval/record/duration_histogram.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace fusebench {

using namespace record;

namespace {

/// By the definition: the place share * (n - 1) of the sorted list, between neighbours in proportion.
double by_hand(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(place));
  if (below + 1 == values.size()) return values.back();
  const double rest = place - static_cast<double>(below);
  return (1 - rest) * values[below] + rest * values[below + 1];
}

std::size_t sum_of(const std::vector<std::size_t>& counts) {
  return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

/// Log-normal around 20 ms, as times of stages are.
std::vector<double> some_durations(std::size_t count) {
  std::mt19937 random(7);
  std::vector<double> durations_ms;
  for (std::size_t i = 0; i < count; ++i)
    durations_ms.push_back(20 * std::exp(1e-9 * static_cast<double>(random()) - 2));
  return durations_ms;
}

TEST(DurationHistogram, PercentilesAreThoseOfTheSortedList) {
  for (const std::size_t count : {2, 3, 10, 101, 1000}) {
    const auto durations_ms = some_durations(count);
    const DurationHistogram histogram = histogram_of(durations_ms);
    EXPECT_EQ(histogram.count, count);
    EXPECT_EQ(histogram.min_ms, *std::min_element(durations_ms.begin(), durations_ms.end()));
    EXPECT_EQ(histogram.max_ms, *std::max_element(durations_ms.begin(), durations_ms.end()));
    EXPECT_NEAR(histogram.median_ms, by_hand(durations_ms, 0.5), 1e-12);
    EXPECT_NEAR(histogram.p90_ms, by_hand(durations_ms, 0.9), 1e-12);
    EXPECT_NEAR(histogram.p99_ms, by_hand(durations_ms, 0.99), 1e-12);
  }
}

TEST(DurationHistogram, EveryDurationIsInOneBin) {
  const auto durations_ms = some_durations(1000);
  const DurationHistogram histogram = histogram_of(durations_ms);
  ASSERT_EQ(histogram.edges_ms.size(), histogram.counts.size() + 1);
  EXPECT_TRUE(std::is_sorted(histogram.edges_ms.begin(), histogram.edges_ms.end()));
  EXPECT_EQ(sum_of(histogram.counts), 1000U);
  for (std::size_t bin = 0; bin < histogram.counts.size(); ++bin) {
    const auto inside = std::count_if(durations_ms.begin(), durations_ms.end(), [&](double duration_ms) {
      return histogram.edges_ms[bin] <= duration_ms && duration_ms < histogram.edges_ms[bin + 1];
    });
    EXPECT_EQ(static_cast<std::ptrdiff_t>(histogram.counts[bin]), inside) << bin;
    EXPECT_NEAR(std::log10(histogram.edges_ms[bin + 1] / histogram.edges_ms[bin]), 0.1, 0.01);
  }
  EXPECT_GT(histogram.counts.front(), 0U);
  EXPECT_GT(histogram.counts.back(), 0U);
}

TEST(DurationHistogram, EdgesAreRoundNumbers) {
  const DurationHistogram histogram = histogram_of({0.3, 3, 30});
  EXPECT_EQ(fmt::format("{}", fmt::join(histogram.edges_ms, " ")),
            "0.25 0.315 0.4 0.5 0.63 0.8 1 1.25 1.6 2 2.5 3.15 4 5 6.3 8 10 12.5 16 20 25 31.5");
  EXPECT_EQ(histogram_of({2.5}).edges_ms, (std::vector{2.5, 3.15}));  // an edge belongs to the bin above
}

TEST(DurationHistogram, OneDurationIsAllOfItsPercentiles) {
  const DurationHistogram histogram = histogram_of({42});
  for (const double value :
       {histogram.min_ms, histogram.median_ms, histogram.p90_ms, histogram.p99_ms, histogram.max_ms})
    EXPECT_EQ(value, 42);
  EXPECT_EQ(histogram.edges_ms, (std::vector<double>{40, 50}));
  EXPECT_EQ(histogram.counts, (std::vector<std::size_t>{1}));
}

TEST(DurationHistogram, EqualDurationsAreOneBin) {
  const DurationHistogram histogram = histogram_of(std::vector<double>(17, 0.7));
  EXPECT_EQ(histogram.median_ms, 0.7);
  EXPECT_EQ(histogram.p99_ms, 0.7);
  EXPECT_EQ(histogram.counts, (std::vector<std::size_t>{17}));
}

TEST(DurationHistogram, WhatIsBeyondTheGridIsInItsLastBins) {
  const DurationHistogram histogram = histogram_of({0, 1e-6, 1, 1e9});
  EXPECT_EQ(sum_of(histogram.counts), 4U);
  EXPECT_EQ(histogram.counts.front(), 2U);
  EXPECT_EQ(histogram.edges_ms.front(), 1e-4);
  EXPECT_EQ(histogram.counts.back(), 1U);
  EXPECT_EQ(histogram.edges_ms.back(), 1e6);
}

}  // namespace
}  // namespace fusebench
