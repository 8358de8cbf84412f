#include "core/estimator/filter/state_validity.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fusebench {

using namespace filter;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(StateValidity, DetectsAnyNan) {
  ASSERT_TRUE(is_valid(GaussianState{}));
  for (int i = 0; i < kStateSize; ++i) {
    for (const double absurd : {kNaN, std::numeric_limits<double>::infinity(), -1e20}) {
      GaussianState state;
      state.covariance(i, kStateSize - 1 - i) = absurd;
      EXPECT_FALSE(is_valid(state)) << "covariance " << i;
      if (i >= kGravity && i < kAngularVelocity) continue;  // moves on the sphere
      if (i < kPosition && absurd == -1e20) continue;       // an angle as any other
      StateVector delta = StateVector::Zero();
      delta[i] = absurd;
      EXPECT_FALSE(is_valid({plus({}, delta), StateMatrix::Zero()})) << "mean " << i << ": " << absurd;
    }
  }
  GaussianState state;
  state.mean.gravity_direction_world.y() = kNaN;
  EXPECT_FALSE(is_valid(state));
}

TEST(StateValidity, WhatACameraDoesIsValid) {
  GaussianState state;
  state.mean.T_world_imu.translation = {300, -20, 5};  // along a corridor
  state.mean.angular_velocity_imu_radps = {35, 0, 0};  // the range of a gyroscope
  state.covariance.diagonal().setConstant(1e4);
  EXPECT_TRUE(is_valid(state));
}

}  // namespace
}  // namespace fusebench
