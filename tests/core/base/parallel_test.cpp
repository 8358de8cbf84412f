#include "core/base/parallel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace fusebench {
namespace {

/// A sum whose value depends on the order of additions.
double ordered_sum(int threads) {
  const Workers workers(threads);
  const auto parts = workers.map_chunks<double>(100'000, 64, [](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += std::sin(static_cast<double>(i)) * 1e-3;
    return sum;
  });
  double sum = 0;
  for (const double part : parts) sum += part;
  return sum;
}

TEST(Parallel, SumsAreTheSameBitsForAnyNumberOfThreads) {
  const double one = ordered_sum(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(ordered_sum(threads), one);
}

TEST(Parallel, EveryElementIsVisitedOnceInFixedChunks) {
  for (const int threads : {1, 4}) {
    const Workers workers(threads);
    std::vector<int> visits(1003, 0);
    workers.for_chunks(visits.size(), 10, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 10, 0U);
      EXPECT_LE(end - begin, 10U);
      for (std::size_t i = begin; i < end; ++i) ++visits[i];
    });
    for (const int count : visits) EXPECT_EQ(count, 1);
  }
}

TEST(Parallel, AcceptsAnEmptyRange) {
  const Workers workers(2);
  workers.for_chunks(0, 5, [](std::size_t, std::size_t) { FAIL(); });
}

TEST(Parallel, ExceptionsArriveAtTheCaller) {
  for (const int threads : {1, 4}) {
    const Workers workers(threads);
    EXPECT_THROW(workers.for_chunks(100, 1,
                                    [](std::size_t begin, std::size_t) {
                                      if (begin == 57) throw std::runtime_error("57");
                                    }),
                 std::runtime_error);
  }
}

}  // namespace
}  // namespace fusebench
