#include "core/estimator/prediction/initialisation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/config/groups/prediction_config.hpp"
#include "tests/support/analytic_motion.hpp"

namespace fusebench {

using namespace config;
using namespace filter;
using namespace prediction;

namespace {

const SE3 kTImuCamera{so3_exp({0.2, -0.1, 1.2}), {0.09, 0.003, 0.002}};

SensorRig rig() {
  SensorRig r;
  r.T_imu_camera = kTImuCamera;
  return r;
}

double sigma(const GaussianState& state, int offset) { return std::sqrt(state.covariance(offset, offset)); }

TEST(Initialisation, AtRestFindsGravityAndTheGyroscopeBias) {
  const Vector3d gravity_imu = Vector3d(0.3, 0.8, -0.5).normalized();
  const Vector3d bias(0.004, -0.01, 0.002);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  std::vector<ImuSample> samples;
  for (int i = 0; i <= 200; ++i) {
    ImuSample s;
    s.timestamp_ns = i * 5'000'000;
    for (int k = 0; k < 3; ++k) {
      s.angular_velocity_radps[k] = bias[k] + 0.002 * normal(generator);
      s.specific_force_mps2[k] = -kGravity_mps2 * gravity_imu[k] + 0.03 * normal(generator);
    }
    samples.push_back(s);
  }
  const auto state = initialise_with_imu(samples, 500'000'000, rig(), InitialisationConfig{});
  ASSERT_TRUE(state.has_value());
  // World is the first camera frame.
  EXPECT_LT((state->mean.T_world_imu * kTImuCamera).translation.norm(), 1e-14);
  const Vector3d gravity_camera = kTImuCamera.rotation.conjugate() * gravity_imu;
  EXPECT_LT((state->mean.gravity_direction_world - gravity_camera).norm(), 0.002);
  EXPECT_LT((state->mean.gyroscope_bias_radps - bias).norm(), 0.001);
  EXPECT_LT(sigma(*state, kVelocity), 0.05);
}

TEST(Initialisation, InMotionTheGroundTruthIsWithinTheCovariance) {
  const testing::HelixMotion motion;
  const auto samples = motion.samples(0, 2, 200);
  const auto state = initialise_with_imu(samples, 1'000'000'000, rig(), InitialisationConfig{});
  ASSERT_TRUE(state.has_value());
  // Ground truth in the estimator's world, the first camera frame.
  const SE3 T_room_camera = motion.T_world_imu(1.0) * kTImuCamera;
  const Vector3d velocity = T_room_camera.rotation.conjugate() * motion.velocity_world_mps(1.0);
  const Vector3d gravity = T_room_camera.rotation.conjugate() * motion.gravity_world_mps2.normalized();
  EXPECT_LT((state->mean.velocity_world_mps - velocity).norm(), 3 * sigma(*state, kVelocity));
  EXPECT_LT(s2_minus(gravity, state->mean.gravity_direction_world).norm(), 2.5 * sigma(*state, kGravity));
  EXPECT_EQ(state->mean.gyroscope_bias_radps.norm(), 0.0) << "in motion the mean rate is no bias";
  EXPECT_GT(sigma(*state, kVelocity), 0.5);
}

TEST(Initialisation, NoSamplesAroundTheFirstFrameIsAnError) {
  const auto samples = testing::HelixMotion{}.samples(5, 6, 200);
  const auto state = initialise_with_imu(samples, 1'000'000'000, rig(), InitialisationConfig{});
  ASSERT_FALSE(state.has_value());
  EXPECT_EQ(state.error().code, ErrorCode::data_corrupt);
}

}  // namespace
}  // namespace fusebench
