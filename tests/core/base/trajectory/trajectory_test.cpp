#include "core/base/trajectory/trajectory.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(WithClockOffset, StampsMoveAndPosesStay) {
  const Trajectory by_other_clock = with_clock_offset(three_poses(), -40);
  const Trajectory trajectory = three_poses();
  ASSERT_EQ(by_other_clock.size(), trajectory.size());
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    EXPECT_EQ(by_other_clock[i].timestamp_ns, trajectory[i].timestamp_ns - 40);
    EXPECT_EQ(by_other_clock[i].T_world_camera.translation, trajectory[i].T_world_camera.translation);
  }
}

TEST(OfPoint, APointOfATurningBodyMovesOnACircle) {
  Trajectory turning;
  for (int i = 0; i < 12; ++i)
    turning.push_back({i * 1000LL, {so3_exp(Vector3d(0, 0, 0.5 * i)), Vector3d(1, 2, 3)}});
  const Trajectory moved = of_point(turning, {0.1, 0, 0.02});
  ASSERT_EQ(moved.size(), turning.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const double angle = 0.5 * static_cast<double>(i);
    const Vector3d expected(1 + 0.1 * std::cos(angle), 2 + 0.1 * std::sin(angle), 3.02);
    EXPECT_LT((moved[i].T_world_camera.translation - expected).norm(), 1e-12) << i;
    EXPECT_EQ(moved[i].T_world_camera.rotation.coeffs(), turning[i].T_world_camera.rotation.coeffs());
    EXPECT_EQ(moved[i].timestamp_ns, turning[i].timestamp_ns);
  }
}

}  // namespace
}  // namespace fusebench
