#include "core/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace trajectory;

namespace {

Trajectory three_poses() {
  return {{100, {Quaterniond::Identity(), {0, 0, 0}}},
          {200, {so3_exp({0, 0, 0.4}), {2, 0, 0}}},
          {500, {so3_exp({0, 0, 1.0}), {2, 3, 0}}}};
}

TEST(InterpolatePose, BetweenAndAtStamps) {
  const Trajectory trajectory = three_poses();
  const auto quarter = interpolate_pose(trajectory, 125, 1000);
  ASSERT_TRUE(quarter);
  EXPECT_TRUE(quarter->translation.isApprox(Vector3d(0.5, 0, 0)));
  EXPECT_NEAR(so3_log(quarter->rotation).z(), 0.1, 1e-12);
  EXPECT_EQ(interpolate_pose(trajectory, 100, 1)->translation, Vector3d(0, 0, 0));
  EXPECT_EQ(interpolate_pose(trajectory, 500, 1)->translation, Vector3d(2, 3, 0));
}

TEST(InterpolatePose, NothingOutsideOrAcrossAGap) {
  const Trajectory trajectory = three_poses();
  EXPECT_FALSE(interpolate_pose(trajectory, 99, 1000));
  EXPECT_FALSE(interpolate_pose(trajectory, 501, 1000));
  EXPECT_FALSE(interpolate_pose(trajectory, 300, 299));
  EXPECT_TRUE(interpolate_pose(trajectory, 300, 300));
  EXPECT_FALSE(interpolate_pose({}, 0, 1000));
}

}  // namespace
}  // namespace fusebench
