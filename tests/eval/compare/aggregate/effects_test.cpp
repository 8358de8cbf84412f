#include "eval/compare/aggregate/effects.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "eval/compare/aggregate/option_bins.hpp"
#include "eval/report/sweep_charts.hpp"
#include "tests/eval/compare/aggregate/sample_rows.hpp"

namespace fusebench {

using namespace record;
using namespace aggregate;
using namespace report;

namespace {

using testing::metric_of;
using testing::sample_bad_row;
using testing::sample_row;
using testing::shuffled;

const std::array<double, 3> kIterations = {std::log(0.5), 0.0, std::log(2.0)};  // of 4, 8, 16
constexpr std::array<const char*, 3> kIterationNames = {"4", "8", "16"};
constexpr std::array<double, 2> kPrior = {-0.3, 0.3};
constexpr std::array<const char*, 2> kPriorNames = {"constant_velocity", "imu"};

/// A full grid on recordings that are as hard as 0.01 m and 1 m: logarithms of effects add up, and
/// `interaction` is added where 16 meets imu.
std::vector<RunRow> grid(double interaction = 0) {
  std::vector<RunRow> rows;
  for (const double base_m : {0.01, 1.0}) {
    for (std::size_t i = 0; i < kIterations.size(); ++i) {
      for (std::size_t j = 0; j < kPrior.size(); ++j) {
        const double extra = i == 2 && j == 1 ? interaction : 0;
        rows.push_back(sample_row(base_m < 0.1 ? "easy" : "hard",
                                  {{"iterations", kIterationNames[i]}, {"prior", kPriorNames[j]}},
                                  base_m * std::exp(kIterations[i] + kPrior[j] + extra)));
      }
    }
  }
  return rows;
}

TEST(Effects, AdditiveEffectsAreRecoveredWhateverTheRecordings) {
  const SweepEffects effects = sweep_effects(grid(), metric_of("ate"));
  EXPECT_EQ(effects.mean, EffectMean::geometric);
  ASSERT_EQ(effects.options.size(), 2U);
  const OptionEffect& iterations = effects.options[0];
  EXPECT_EQ(iterations.option, "iterations");
  ASSERT_EQ(iterations.values.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(iterations.values[i].value, kIterationNames[i]);  // numbers by value: 16 after 8
    EXPECT_NEAR(*iterations.values[i].ratio, std::exp(kIterations[i]), 1e-12);
    EXPECT_EQ(iterations.values[i].n, 4U);
  }
  EXPECT_NEAR(*effects.options[1].values[1].ratio, std::exp(0.3), 1e-12);
}

TEST(Effects, IndependentOptionsDoNotInteract) {
  const SweepEffects effects = sweep_effects(grid(), metric_of("ate"));
  ASSERT_EQ(effects.interactions.size(), 1U);
  for (const auto& line : effects.interactions[0].cells) {
    for (const InteractionCell& cell : line) {
      EXPECT_NEAR(*cell.beyond_main, 1, 1e-12);
      EXPECT_EQ(cell.n, 2U);
    }
  }
  EXPECT_NEAR(*effects.interactions[0].cells[2][0].ratio, 2 * std::exp(-0.3), 1e-12);
}

TEST(Effects, AnInteractionIsWhatTheMainEffectsDoNotSay) {
  // Of an excess e in one of 3 x 2 cells the means take e/6, the row e/2 and the column e/3.
  const SweepEffects effects = sweep_effects(grid(0.6), metric_of("ate"));
  const double excess = 0.6;
  EXPECT_NEAR(std::log(*effects.interactions[0].cells[2][1].beyond_main),
              excess - excess / 2 - excess / 3 + excess / 6, 1e-12);
}

TEST(Effects, ValuesThatMayBeZeroHaveArithmeticMeans) {
  const std::vector<RunRow> rows = {sample_row("easy", {{"a", "0"}}, 0), sample_row("easy", {{"a", "1"}}, 2),
                                    sample_row("still", {{"a", "0"}}, 0),
                                    sample_row("still", {{"a", "1"}}, 0)};
  const SweepEffects effects = sweep_effects(rows, metric_of("ate"));
  EXPECT_EQ(effects.mean, EffectMean::arithmetic);
  EXPECT_DOUBLE_EQ(*effects.options[0].values[0].ratio, 0);
  EXPECT_DOUBLE_EQ(*effects.options[0].values[1].ratio, 2);
  EXPECT_EQ(effects.options[0].values[1].n, 1U);  // where all are zero there is no ratio
}

TEST(Effects, LostAndFailedRunsAreCountedAtTheirValue) {
  auto rows = grid();
  rows.push_back(sample_bad_row("easy", {{"iterations", "4"}, {"prior", "imu"}}, RunStatus::lost));
  rows.push_back(sample_bad_row("easy", {{"iterations", "32"}, {"prior", "imu"}}, RunStatus::failed));
  rows.push_back(sample_bad_row("easy", {}, RunStatus::failed));
  rows.back().options_known = false;
  const SweepEffects effects = sweep_effects(rows, metric_of("ate"));
  const OptionEffect& iterations = effects.options[0];
  EXPECT_EQ(iterations.values[0].n_lost, 1U);
  EXPECT_EQ(iterations.values[0].n_failed, 0U);
  EXPECT_EQ(iterations.values[0].n_total, 5U);
  ASSERT_EQ(iterations.values.size(), 4U);
  EXPECT_EQ(iterations.values[3].n_failed, 1U);
  EXPECT_FALSE(iterations.values[3].ratio.has_value());
  EXPECT_EQ(iterations.values[3].n_total, 1U);
}

TEST(Effects, AnOptionThatSomeRunsLeaveAloneIsSwept) {
  const std::vector<RunRow> rows = {sample_row("easy", {}, 1), sample_row("easy", {{"a", "1"}}, 4)};
  const SweepEffects effects = sweep_effects(rows, metric_of("ate"));
  ASSERT_EQ(effects.options.size(), 1U);
  EXPECT_EQ(effects.options[0].values[1].value, kUnsetOption);
  EXPECT_NEAR(*effects.options[0].values[1].ratio, 0.5, 1e-12);
  EXPECT_TRUE(
      sweep_effects(std::vector{sample_row("easy", {{"a", "1"}}, 4)}, metric_of("ate")).options.empty());
}

TEST(Effects, DoNotDependOnTheOrderOfRuns) {
  const auto rows = grid(0.123);
  const SweepEffects expected = sweep_effects(rows, metric_of("ate"));
  for (unsigned seed = 0; seed < 20; ++seed) {
    const SweepEffects effects = sweep_effects(shuffled(rows, seed), metric_of("ate"));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(effects.options[0].values[i].ratio, expected.options[0].values[i].ratio);
      EXPECT_EQ(effects.interactions[0].cells[i][1].ratio, expected.interactions[0].cells[i][1].ratio);
    }
  }
}

TEST(SweepCharts, NumbersAreCurvesAndTextsAreBars) {
  auto rows = grid();
  rows.push_back(sample_bad_row("easy", {{"iterations", "4"}, {"prior", "imu"}}, RunStatus::lost));
  const SweepEffects effects = sweep_effects(rows, metric_of("ate"));
  const auto charts = effect_charts(effects);
  ASSERT_EQ(charts.size(), 4U);
  EXPECT_TRUE(charts[0].categories.empty());
  EXPECT_DOUBLE_EQ(charts[0].series[0].points[2].x(), 16);
  EXPECT_NEAR(charts[0].series[0].points[2].y(), 2, 1e-12);
  EXPECT_DOUBLE_EQ(charts[1].series[0].points[0].y(), 20);  // lost at 4, in percent
  EXPECT_EQ(charts[2].categories, (std::vector<std::string>{"constant_velocity", "imu"}));
  const auto pairs = interaction_charts(effects);
  ASSERT_EQ(pairs.size(), 1U);
  ASSERT_EQ(pairs[0].series.size(), 2U);
  EXPECT_EQ(pairs[0].series[1].label, "prior = imu");
  EXPECT_EQ(pairs[0].series[1].points.size(), 3U);
}

TEST(SweepCharts, OptionsThatAlwaysChangeTogetherHaveNoCurves) {
  const std::vector<RunRow> rows = {sample_row("easy", {{"a", "1"}, {"b", "10"}}, 1),
                                    sample_row("easy", {{"a", "2"}, {"b", "20"}}, 2)};
  const SweepEffects effects = sweep_effects(rows, metric_of("ate"));
  EXPECT_EQ(effects.interactions.size(), 1U);
  EXPECT_TRUE(interaction_charts(effects).empty());
}

TEST(SweepCharts, ThereAreAtMostEightCurves) {
  std::vector<RunRow> rows;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j)
      rows.push_back(sample_row("easy", {{"a", std::to_string(i)}, {"b", std::to_string(j)}}, 1 + i + j));
  }
  const auto charts = interaction_charts(sweep_effects(rows, metric_of("ate")));
  ASSERT_EQ(charts.at(0).series.size(), 8U);
  EXPECT_EQ(charts[0].series.front().label, "b = 0");
  EXPECT_EQ(charts[0].series.back().label, "b = 19");
  EXPECT_NE(charts[0].caption.find("8 of 20 values of b"), std::string::npos);
}

TEST(OptionBins, ManyNumbersBecomeAFewOfEqualSize) {
  std::vector<RunRow> rows;
  for (int i = 0; i < 60; ++i) {
    rows.push_back(
        sample_row("easy", {{"drawn", std::to_string(i)}, {"few", i % 2 == 0 ? "1" : "2"}}, 1 + i));
  }
  const auto binned = with_binned_options(shuffled(rows, 3), 12, 6);
  const SweepEffects effects = sweep_effects(binned, metric_of("ate"));
  ASSERT_EQ(effects.options.size(), 2U);
  ASSERT_EQ(effects.options[0].values.size(), 6U);
  for (const EffectValue& value : effects.options[0].values) EXPECT_EQ(value.n, 10U);
  EXPECT_EQ(effects.options[0].values.front().value, "4.5");
  EXPECT_EQ(effects.options[1].values.size(), 2U);
  rows[7].options[0].second = "auto";
  EXPECT_EQ(sweep_effects(with_binned_options(rows, 12, 6), metric_of("ate")).options[0].values.size(), 60U);
}

}  // namespace
}  // namespace fusebench
