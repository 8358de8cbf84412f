#include "eval/report/run_charts/chart_parts.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fusebench {

using namespace page;
using namespace run_charts;

namespace {

Chart chart_with_peaks(const std::vector<std::pair<std::string, double>>& peaks) {
  Chart chart;
  chart.left_label = "error [cm]";
  for (const auto& [label, peak] : peaks) chart.series.push_back({label, {{0, 0.1}, {1, peak}, {2, 0.2}}});
  return chart;
}

TEST(FarValues, OneBadRunIsCutAndSaid) {
  Chart chart = chart_with_peaks({{"full", 1.1}, {"dm", 2.0}, {"no-imu", 340}});
  cut_far_values(chart);
  ASSERT_TRUE(chart.y_range.has_value());
  EXPECT_GE(chart.y_range->y(), 2.0);
  EXPECT_LE(chart.y_range->y(), 4.0);
  EXPECT_EQ(chart.caption, "Cut at 2.5 cm, where triangles stand: no-imu reaches 340 cm.");
  EXPECT_EQ(chart.series[2].points[1].y(), 340) << "what is cut is still there";
}

TEST(FarValues, ABandThatIsCutHasNoTriangles) {
  Chart chart = chart_with_peaks({{"full", 1.1}, {"dm", 2.0}, {"full, 3 sigma", 340}});
  chart.series.back().style = SeriesStyle::band;
  cut_far_values(chart);
  EXPECT_EQ(chart.caption, "Cut at 2.5 cm: full, 3 sigma reaches 340 cm.");
}

TEST(FarValues, RunsThatAreAlikeAreNotCut) {
  Chart alike = chart_with_peaks({{"full", 1.1}, {"dm", 2.0}, {"no-imu", 5.2}});
  cut_far_values(alike);
  EXPECT_FALSE(alike.y_range.has_value());
  Chart single = chart_with_peaks({{"full", 500}});
  cut_far_values(single);
  EXPECT_FALSE(single.y_range.has_value());
  EXPECT_TRUE(single.caption.empty());
}

TEST(FarPlaces, AViewStaysAroundTheGroundTruth) {
  Chart chart;
  chart.equal_scale = true;
  chart.series = {{"ground truth", {{0, 0}, {2, 1}}, SeriesStyle::backdrop},
                  {"full", {{0.1, 0}, {2.2, 1}}},
                  {"dm", {{0, 0}, {90, -400}}}};
  cut_far_places(chart);
  ASSERT_TRUE(chart.x_range && chart.y_range);
  EXPECT_LT(chart.x_range->y(), 5);
  EXPECT_GT(chart.x_range->y(), 2.2);
  EXPECT_GT(chart.y_range->x(), -3);
  EXPECT_EQ(chart.caption, "Cut around the ground truth; beyond it runs dm.");
  chart.series.pop_back();
  chart.x_range.reset();
  chart.y_range.reset();
  cut_far_places(chart);
  EXPECT_FALSE(chart.x_range.has_value());
}

}  // namespace
}  // namespace fusebench
