#include "core/estimator/health/stage_times.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace health;

namespace {

using std::chrono::milliseconds;

StageSpan span_of(Stage stage, int begin_ms, int end_ms) {
  const std::chrono::steady_clock::time_point start{};
  return {stage, {start + milliseconds(begin_ms), start + milliseconds(end_ms)}};
}

double sum_ms(const StageTimes& times, Stage stage) {
  return times.sums_ms()[static_cast<std::size_t>(stage)];
}

TEST(StageTimes, StretchesOfAStageAddUp) {
  StageTimes times;
  times.add(span_of(Stage::predict, 0, 1));
  times.add(span_of(Stage::update, 1, 11));
  times.add(span_of(Stage::update, 12, 17));
  StageTimes later;
  later.add(span_of(Stage::update, 20, 22));
  later.add(span_of(Stage::fuse, 22, 25));
  times.add(later);
  EXPECT_DOUBLE_EQ(sum_ms(times, Stage::predict), 1);
  EXPECT_DOUBLE_EQ(sum_ms(times, Stage::update), 17);
  EXPECT_DOUBLE_EQ(sum_ms(times, Stage::fuse), 3);
  EXPECT_EQ(sum_ms(times, Stage::refresh), 0);
  ASSERT_EQ(times.spans().size(), 5U);
  EXPECT_EQ(times.spans()[4].stage, Stage::fuse);
  EXPECT_DOUBLE_EQ(times.spans()[4].time.milliseconds(), 3);
}

TEST(StageTimes, SumsIncludeSpansBeyondTheCapacity) {
  StageTimes times;
  constexpr int kMany = static_cast<int>(StageTimes::kMostSpans) + 5;
  for (int i = 0; i < kMany; ++i) times.add(span_of(Stage::fuse, 2 * i, 2 * i + 1));
  EXPECT_EQ(times.spans().size(), StageTimes::kMostSpans);
  EXPECT_DOUBLE_EQ(sum_ms(times, Stage::fuse), kMany);
  times.add(StageTimes(times));
  EXPECT_EQ(times.spans().size(), StageTimes::kMostSpans);
  EXPECT_DOUBLE_EQ(sum_ms(times, Stage::fuse), 2 * kMany);
}

}  // namespace
}  // namespace fusebench
