#include "eval/report/speed_sections.hpp"

#include <gtest/gtest.h>

#include "core/base/geometry.hpp"

namespace fusebench {

using namespace report;

namespace {

/// Turns by this speed for a second; the last frames are lost.
RunSeries turning(double degps, std::size_t lost) {
  RunSeries run;
  constexpr std::size_t kTurnFrames = 30;
  for (std::size_t i = 0; i < kTurnFrames; ++i) {
    const auto stamp_ns = static_cast<std::int64_t>(i) * 33'000'000;
    const SE3 pose{so3_exp({0, radians(degps) * 0.033 * static_cast<double>(i), 0}), Vector3d(0, 0, 0)};
    run.truth.push_back({stamp_ns, pose});
    run.frames.emplace_back();
    run.frames.back().timestamp_ns = stamp_ns;
    if (i + lost < kTurnFrames) run.poses.push_back({stamp_ns, pose, pose, 0});
  }
  return run;
}

TEST(SpeedSections, CountsTheFramesOfEachMethod) {
  SpeedFailures failures;
  failures.add(turning(20, 0), "full");
  failures.add(turning(120, 0), "full");
  failures.add(turning(20, 0), "icp");
  failures.add(turning(120, 10), "icp");
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
  EXPECT_TRUE(table.rows[1].cells[3].ends_with("(10 lost, 0 silent)")) << table.rows[1].cells[3];
  EXPECT_TRUE(table.rows[0].cells[3].starts_with("0 % of 2")) << table.rows[0].cells[3];
}

TEST(SpeedSections, AreNoneWhereNothingIsFastOrFails) {
  SpeedFailures slow, right;
  slow.add(turning(20, 10), "full");
  EXPECT_TRUE(slow.sections().empty());
  right.add(turning(120, 0), "full");
  EXPECT_TRUE(right.sections().empty());
}

}  // namespace
}  // namespace fusebench
