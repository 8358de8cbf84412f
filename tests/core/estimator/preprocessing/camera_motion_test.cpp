#include "core/estimator/preprocessing/camera_motion.hpp"

#include <gtest/gtest.h>

namespace fusebench {

using namespace preprocessing;

namespace {

TEST(CameraMotion, AChangeOfEitherVelocityBeyondItsOptionIsMuch) {
  const VelocityTolerance tolerance{.angular_radps = 0.2, .linear_mps = 0.1};
  const filter::FilterState before;
  filter::FilterState now;
  EXPECT_FALSE(velocity_changed_much(before, now, tolerance));
  now.velocity_world_mps = before.velocity_world_mps + Vector3d(0, 0.09, 0);
  now.angular_velocity_imu_radps = before.angular_velocity_imu_radps + Vector3d(0.19, 0, 0);
  EXPECT_FALSE(velocity_changed_much(before, now, tolerance));
  now.velocity_world_mps.y() += 0.02;
  EXPECT_TRUE(velocity_changed_much(before, now, tolerance));
  now.velocity_world_mps = before.velocity_world_mps;
  now.angular_velocity_imu_radps.x() += 0.02;
  EXPECT_TRUE(velocity_changed_much(before, now, tolerance));
}

/// Against the camera's pose a moment later.
TEST(CameraMotion, TheCameraMovesWithTheLeverArmOfTheImu) {
  filter::FilterState state;
  state.T_world_imu = {so3_exp({0.4, -0.3, 0.8}), {1.0, 2.0, -0.5}};
  state.velocity_world_mps = {0.3, -0.7, 0.2};
  state.angular_velocity_imu_radps = {1.5, -0.8, 2.0};
  const SE3 T_imu_camera{so3_exp({0.1, 1.2, -0.4}), {0.1, -0.2, 0.3}};
  constexpr double kStep_s = 1e-6;
  const SE3 later{state.T_world_imu.rotation * so3_exp(kStep_s * state.angular_velocity_imu_radps),
                  state.T_world_imu.translation + kStep_s * state.velocity_world_mps};
  const SE3 moved = (state.T_world_imu * T_imu_camera).inverse() * (later * T_imu_camera);
  const CameraVelocity velocity = camera_velocity(state, T_imu_camera);
  EXPECT_LT((velocity.angular_radps - so3_log(moved.rotation) / kStep_s).norm(), 1e-5);
  EXPECT_LT((velocity.linear_mps - moved.translation / kStep_s).norm(), 1e-5);
}

}  // namespace
}  // namespace fusebench
