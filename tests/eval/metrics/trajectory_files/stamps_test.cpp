#include "eval/metrics/trajectory_files/stamps.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "eval/metrics/trajectory_files/trajectory_pair.hpp"

namespace fusebench {

using namespace trajectory_files;

namespace {

constexpr std::int64_t kMost_ns = std::numeric_limits<std::int64_t>::max();

TEST(Stamps, SecondsThatNanosecondsDoNotHoldAreClamped) {
  EXPECT_EQ(nanoseconds(0.02), 20'000'000);
  EXPECT_EQ(nanoseconds(-0.02), -20'000'000);
  for (const double seconds : {9.3e9, 1e10, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(nanoseconds(seconds), kMost_ns) << seconds;
    EXPECT_EQ(nanoseconds(-seconds), -kMost_ns) << seconds;
  }
  EXPECT_GT(nanoseconds(9.2e9), 9'100'000'000'000'000'000);
}

TEST(Stamps, SumsAreClamped) {
  EXPECT_EQ(clamped_sum(3, -5), -2);
  EXPECT_EQ(clamped_sum(kMost_ns, 1), kMost_ns);
  EXPECT_EQ(clamped_sum(kMost_ns, -1), kMost_ns - 1);
  EXPECT_EQ(clamped_sum(std::numeric_limits<std::int64_t>::min(), -1), -kMost_ns);
}

TEST(Stamps, ALimitThatDoesNotFitIsNoLimit) {
  Trajectory trajectory(20);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    trajectory[i].timestamp_ns = 1'305'031'102'000'000'000 + static_cast<std::int64_t>(i) * 100'000'000;
    trajectory[i].T_world_camera.translation.x() = static_cast<double>(i);
  }
  for (const AssociationRule rule : {AssociationRule::nearest, AssociationRule::greedy,
                                     AssociationRule::interpolated, AssociationRule::held}) {
    AssociationOptions options;
    options.rule = rule;
    for (const double limit_s : {1e10, 1e19, 1e300, std::numeric_limits<double>::infinity()}) {
      options.max_difference_s = limit_s;
      const auto pair = pair_up(trajectory, trajectory, options);
      ASSERT_TRUE(pair.has_value()) << to_string(rule) << ", " << limit_s << ": " << pair.error().message;
      EXPECT_EQ(pair->size(), trajectory.size()) << to_string(rule) << ", " << limit_s;
    }
  }
}

}  // namespace
}  // namespace fusebench
