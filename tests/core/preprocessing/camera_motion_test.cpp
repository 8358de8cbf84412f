#include "core/preprocessing/camera_motion.hpp"

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

}  // namespace
}  // namespace fusebench
