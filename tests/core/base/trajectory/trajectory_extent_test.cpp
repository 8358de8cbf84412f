#include "core/base/trajectory/trajectory_extent.hpp"

#include <gtest/gtest.h>

namespace fusebench {
namespace {

Trajectory line(std::int64_t from_ns, std::int64_t to_ns) {
  Trajectory poses;
  for (std::int64_t t = from_ns; t <= to_ns; ++t)
    poses.push_back(
        {t, SE3{Quaterniond::Identity(), {3.0 * static_cast<double>(t), 4.0 * static_cast<double>(t), 0}}});
  return poses;
}

TEST(TrajectoryExtent, IsTheDiagonalOfTheBox) {
  EXPECT_EQ(trajectory::extent_m({}), 0);
  EXPECT_EQ(trajectory::extent_m(line(7, 7)), 0);
  EXPECT_DOUBLE_EQ(trajectory::extent_m(line(0, 10)), 50);
}

TEST(TrajectoryExtent, ATrackerThatStopsEarlyCoversAShareOfTheTime) {
  const Trajectory whole = line(0, 100);
  EXPECT_DOUBLE_EQ(trajectory::covered_share_of_time(whole, whole), 1);
  EXPECT_DOUBLE_EQ(trajectory::covered_share_of_time(whole, line(-50, 25)), 0.25);
  EXPECT_DOUBLE_EQ(trajectory::covered_share_of_time(whole, line(200, 300)), 0);
  Trajectory with_hole = line(0, 30);
  for (const StampedPose& pose : line(70, 100)) with_hole.push_back(pose);
  EXPECT_DOUBLE_EQ(trajectory::covered_share_of_time(whole, with_hole), 0.6);
  EXPECT_DOUBLE_EQ(trajectory::covered_share_of_time(whole, {}), 0);
  EXPECT_DOUBLE_EQ(trajectory::covered_share_of_time(line(7, 7), whole), 1) << "no duration";
}

TEST(TrajectoryExtent, WithinTheTimeOfAnotherTrajectoryBothEndsCount) {
  const Trajectory within = trajectory::within_time_of(line(0, 10), line(4, 6));
  ASSERT_EQ(within.size(), 3U);
  EXPECT_EQ(within.front().timestamp_ns, 4);
  EXPECT_EQ(within.back().timestamp_ns, 6);
  Trajectory backwards = line(4, 6);
  std::swap(backwards.front(), backwards.back());
  EXPECT_EQ(trajectory::within_time_of(line(0, 10), backwards).size(), 3U) << "in any order";
  EXPECT_TRUE(trajectory::within_time_of(line(0, 10), line(20, 30)).empty());
  EXPECT_TRUE(trajectory::within_time_of(line(0, 10), {}).empty());
}

}  // namespace
}  // namespace fusebench
