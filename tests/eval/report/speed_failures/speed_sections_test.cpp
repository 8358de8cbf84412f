#include "eval/report/speed_failures/speed_sections.hpp"

#include <gtest/gtest.h>

#include "core/base/geometry.hpp"

namespace fusebench {

using namespace speed_failures;

namespace {

/// A camera that turns by this speed for a second; the last poses of the estimate are missing.
void add(FailureSections& failures, const std::string& method, double degps, std::size_t lost) {
  constexpr std::size_t kTurnFrames = 30;
  Trajectory truth;
  std::vector<std::int64_t> stamps;
  for (std::size_t i = 0; i < kTurnFrames; ++i) {
    stamps.push_back(static_cast<std::int64_t>(i) * 33'000'000);
    const double angle_rad = radians(degps) * 0.033 * static_cast<double>(i);
    truth.push_back({stamps.back(), {so3_exp({0, angle_rad, 0}), Vector3d(0, 0, 0)}});
  }
  const Trajectory estimate(truth.begin(), truth.end() - static_cast<std::ptrdiff_t>(lost));
  failures.add(method, 1, truth, stamps, estimate);
}

TEST(SpeedSections, CountsTheFramesOfEachMethod) {
  FailureSections failures;
  add(failures, "full", 20, 0);
  add(failures, "full", 120, 0);
  add(failures, "icp", 20, 0);
  add(failures, "icp", 120, 10);
  const auto sections = failures.sections();
  ASSERT_EQ(sections.size(), 2U);
  const auto& chart = std::get<std::vector<page::Chart>>(sections[0].content).front();
  ASSERT_EQ(chart.series.size(), 2U);
  EXPECT_EQ(chart.series[0].points, (std::vector<Vector2d>{{25, 0}, {125, 0}}));
  EXPECT_GT(chart.series[1].points[1].y(), 30);
  const auto& table = std::get<page::PageTable>(sections[1].content);
  ASSERT_EQ(table.header.size(), 4U);
  EXPECT_EQ(table.header[3], "100 to 150 deg/s");
  EXPECT_EQ(table.rows[1].cells[0], "icp");
  EXPECT_EQ(table.rows[1].cells[2], "-");
  EXPECT_TRUE(table.rows[1].cells[3].ends_with("(10 lost, 0 undetected)")) << table.rows[1].cells[3];
  EXPECT_TRUE(table.rows[0].cells[3].starts_with("0 % of 2")) << table.rows[0].cells[3];
}

TEST(SpeedSections, AreNoneWhereNothingIsFastOrFails) {
  FailureSections slow, right;
  add(slow, "full", 20, 10);
  EXPECT_TRUE(slow.sections().empty());
  add(right, "full", 120, 0);
  EXPECT_TRUE(right.sections().empty());
}

}  // namespace
}  // namespace fusebench
