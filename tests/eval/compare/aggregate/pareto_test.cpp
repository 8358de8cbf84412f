#include "eval/compare/aggregate/pareto.hpp"

#include <gtest/gtest.h>

#include "eval/report/sweep_charts.hpp"
#include "tests/eval/compare/aggregate/sample_rows.hpp"

namespace fusebench {

using namespace record;
using namespace aggregate;
using namespace page;
using namespace report;

namespace {

using testing::metric_of;
using testing::sample_bad_row;
using testing::sample_row;
using testing::shuffled;

RunRow point(const char* name, double cpu_ms, double ate_m) {
  return sample_row("desk", {{"a", name}}, ate_m, cpu_ms);
}

std::vector<std::string> names_of(const std::vector<ParetoPoint>& points) {
  std::vector<std::string> names;
  for (const ParetoPoint& p : points) names.push_back(p.options.at(0).second);
  return names;
}

/// On the front: fast, middle and its twin, slow.
std::vector<RunRow> known_front() {
  return {point("slow", 30, 0.01),      point("middle", 20, 0.02), point("twin", 20, 0.02),
          point("fast", 10, 0.04),      point("worse", 25, 0.03),  point("same time", 20, 0.025),
          point("same value", 35, 0.01)};
}

TEST(Pareto, FindsTheKnownFrontInTheOrderOfTime) {
  const ParetoFront front = pareto_front(known_front(), metric_of("ate"));
  EXPECT_EQ(names_of(front.front()), (std::vector<std::string>{"fast", "middle", "twin", "slow"}));
  EXPECT_EQ(front.points.size(), 7U);
  EXPECT_EQ(front.left_out, 0U);
}

TEST(Pareto, DoesNotDependOnTheOrderOfRuns) {
  const auto expected = names_of(pareto_front(known_front(), metric_of("ate")).points);
  for (unsigned seed = 0; seed < 20; ++seed)
    EXPECT_EQ(names_of(pareto_front(shuffled(known_front(), seed), metric_of("ate")).points), expected);
}

TEST(Pareto, PointsAreMeansOverRecordings) {
  const ParetoFront front = pareto_front(
      std::vector{sample_row("desk", {{"a", "1"}}, 0.01, 10), sample_row("room", {{"a", "1"}}, 0.03, 30)},
      metric_of("ate"));
  ASSERT_EQ(front.points.size(), 1U);
  EXPECT_DOUBLE_EQ(front.points[0].value, 0.02);
  EXPECT_DOUBLE_EQ(front.points[0].cpu_ms_per_frame, 20);
}

TEST(Pareto, ConfigurationsThatDidNotDoAllAreLeftOut) {
  auto rows = known_front();
  rows.push_back(sample_bad_row("desk", {{"a", "lost"}}, RunStatus::lost));
  rows.push_back(point("imported", 1, 0.001));
  rows.back().numbers.set(registry::run_metric("cpu_ms_per_frame"), std::nullopt);
  const ParetoFront front = pareto_front(rows, metric_of("ate"));
  EXPECT_EQ(front.left_out, 2U);
  EXPECT_EQ(front.front().size(), 4U);
}

TEST(Pareto, RecordingsWithoutTheNumberDoNotCount) {
  auto rows = known_front();
  rows.push_back(sample_row("walk", {{"a", "fast"}}, 0, 1000));
  rows.back().numbers.set(registry::run_metric("ate_rmse_m"), std::nullopt);
  const ParetoFront front = pareto_front(rows, metric_of("ate"));
  EXPECT_EQ(front.recordings, (std::vector<std::string>{"desk"}));
  EXPECT_DOUBLE_EQ(front.front()[0].cpu_ms_per_frame, 10);
}

TEST(Pareto, TheChartHasTheFrontAsALine) {
  const Chart chart = pareto_chart(pareto_front(known_front(), metric_of("ate")));
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].points.size(), 4U);
  EXPECT_EQ(chart.series[1].points.size(), 7U);
  EXPECT_DOUBLE_EQ(chart.series[0].points[0].y(), 4);  // cm
}

TEST(Pareto, OfNoRunsThereIsNone) { EXPECT_TRUE(pareto_front({}, metric_of("ate")).points.empty()); }

}  // namespace
}  // namespace fusebench
