#include "core/base/trajectory/noisy_pose.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fusebench::trajectory {
namespace {

TEST(NoisyPose, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const SE3 first = noisy_pose(1, 1e-6);
  EXPECT_EQ(first.translation, noisy_pose(1, 1e-6).translation);
  EXPECT_EQ(first.rotation.coeffs(), noisy_pose(1, 1e-6).rotation.coeffs());
  EXPECT_NE(first.translation, noisy_pose(2, 1e-6).translation);
}

TEST(NoisyPose, HasTheStandardDeviationThatIsAskedFor) {
  constexpr double kNoise = 1e-6;
  constexpr int kCount = 2000;
  Vector6d squares = Vector6d::Zero();
  for (std::uint64_t k = 1; k <= kCount; ++k)
    squares += pose_minus(noisy_pose(k, kNoise), SE3{}).cwiseAbs2() / kCount;
  // The standard deviation of a variance of n normal numbers is sqrt(2 / n) of it: 3 %.
  for (const double square : squares) EXPECT_NEAR(std::sqrt(square) / kNoise, 1, 0.1);
}

TEST(NoisyPose, WithoutNoiseIsTheIdentity) {
  EXPECT_EQ(noisy_pose(3, 0).translation, Vector3d::Zero());
  EXPECT_EQ(noisy_pose(3, 0).rotation.w(), 1);
}

}  // namespace
}  // namespace fusebench::trajectory
