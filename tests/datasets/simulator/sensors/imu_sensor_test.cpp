#include "datasets/simulator/sensors/imu_sensor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/estimator/prediction/imu_preintegration.hpp"
#include "datasets/simulator/motion/motion.hpp"

namespace fusebench {

using namespace prediction;
using namespace synthetic_imu;
using namespace simulator::motion;
using namespace simulator::sensors;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
const Vector3d kGravity_world(0, 0, -kGravity_mps2);
const Vector3d kNone = Vector3d::Zero();

ImuErrors no_errors() {
  ImuErrors errors;
  errors.sensor = ImuSensor{"ideal", {}, 0, 0};
  return errors;
}

PoseSpline motion_of(MotionPreset preset, std::uint64_t seed) {
  MotionOptions options = motion_preset(preset);
  options.from_rest = false;
  const MotionSpan span{0, 750'000'000, 8 * kSecond_ns};
  const Eigen::AlignedBox3d box(Vector3d(-1, -1, 1), Vector3d(1, 1, 1.7));
  return body_motion(hand_held_motion(options, span, box, seed).value(),
                     {so3_exp({0.01, 0.02, 0}), {0.09, 0, 0}});
}

/// State that the samples give by integration from the true state at begin to end, and the covariance by
/// their noise.
struct Drift {
  Vector3d position_m;  ///< in the IMU frame at the beginning
  Vector3d velocity_mps;
  Vector3d rotation_rad;
  Matrix9d covariance;
};

Drift drift(const SimulatedImu& imu, std::int64_t begin_ns, std::int64_t end_ns, const ImuNoise& noise) {
  const auto state_at = [&](std::int64_t time_ns) -> const ImuState& {
    const auto found = std::ranges::find(imu.states, time_ns, &ImuState::timestamp_ns);
    EXPECT_NE(found, imu.states.end());
    return *found;
  };
  const ImuState& a = state_at(begin_ns);
  const ImuState& b = state_at(end_ns);
  const auto sum =
      preintegrate(imu.samples, begin_ns, end_ns, {a.bias.gyroscope_radps, a.bias.accelerometer_mps2}, noise);
  EXPECT_TRUE(sum);
  const double t = sum->duration_s;
  const Quaterniond& R = a.motion.T_world_body.rotation;
  const Vector3d position = a.motion.T_world_body.translation + a.motion.velocity_world_mps * t +
                            0.5 * t * t * kGravity_world + R * sum->delta_position_m;
  const Vector3d velocity = a.motion.velocity_world_mps + t * kGravity_world + R * sum->delta_velocity_mps;
  return {R.conjugate() * (position - b.motion.T_world_body.translation),
          R.conjugate() * (velocity - b.motion.velocity_world_mps),
          so3_log(b.motion.T_world_body.rotation.conjugate() * R * sum->delta_rotation), sum->covariance};
}

TEST(ImuSensor, IdealSamplesFollowTheTruePath) {
  // Shaking needs more samples: at 200 Hz, the mid-point rule itself is off by millimetres after 5 s.
  for (const auto& [preset, rate_hz] :
       {std::pair{MotionPreset::slow, 200.0}, std::pair{MotionPreset::fast, 200.0},
        std::pair{MotionPreset::shake, 1000.0}}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(::testing::Message() << to_string(preset) << " seed " << seed);
      const SimulatedImu imu =
          simulate_imu(motion_of(preset, seed), 0, 8 * kSecond_ns, rate_hz, no_errors(), seed);
      const Drift off = drift(imu, kSecond_ns, 6 * kSecond_ns, {});
      EXPECT_LT(off.position_m.norm(), 1e-3);
      EXPECT_LT(off.velocity_mps.norm(), 1e-3);
      EXPECT_LT(off.rotation_rad.norm(), 2e-4);
    }
  }
}

TEST(ImuSensor, NoisySamplesDriftAsTheirNoisePredicts) {
  // Over 1 s from the true state and biases: the normalised square error of nine dimensions has the mean 9.
  // The walk of the biases, which the covariance leaves out, adds less than 2 % here.
  ImuErrors errors;
  double sum = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const SimulatedImu imu =
        simulate_imu(motion_of(MotionPreset::fast, 1), 0, 8 * kSecond_ns, 200, errors, seed);
    for (std::int64_t begin = kSecond_ns; begin < 7 * kSecond_ns; begin += kSecond_ns) {
      const Drift off = drift(imu, begin, begin + kSecond_ns, errors.sensor.noise);
      Eigen::Matrix<double, 9, 1> error;
      error << off.rotation_rad, off.velocity_mps, off.position_m;
      sum += error.dot(off.covariance.ldlt().solve(error));
      ++count;
    }
  }
  EXPECT_NEAR(sum / count, 9, 4 * std::sqrt(18.0 / count));
}

TEST(ImuSensor, RestReadsGravityUpwards) {
  PoseSpline still(0, kSecond_ns, 20'000'000);
  const Quaterniond tilted = so3_exp({0.4, -0.2, 0.1});
  for (Quaterniond& q : still.rotation_world_body) q = tilted;
  for (const ImuSample& sample : simulate_imu(still, 0, kSecond_ns, 200, no_errors(), 1).samples) {
    EXPECT_LT((tilted * sample.specific_force_mps2 - Vector3d(0, 0, kGravity_mps2)).norm(), 1e-9);
    EXPECT_LT(sample.angular_velocity_radps.norm(), 1e-12);
  }
}

TEST(ImuSensor, GainsBiasesAndRangesAreAsStated) {
  const PoseSpline body = motion_of(MotionPreset::fast, 2);
  const SimulatedImu ideal = simulate_imu(body, 0, 4 * kSecond_ns, 200, no_errors(), 1);
  ImuErrors errors = no_errors();
  errors.gyroscope_gain << 1.02, 0.003, -0.001, 0, 0.98, 0.002, 0.001, 0, 1.01;
  errors.accelerometer_gain = Vector3d(1.01, 1.02, 0.97).asDiagonal();
  errors.sensor.initial_gyroscope_bias_radps = 0.01;
  errors.sensor.initial_accelerometer_bias_mps2 = 0.1;
  const SimulatedImu scaled = simulate_imu(body, 0, 4 * kSecond_ns, 200, errors, 7);
  ASSERT_EQ(scaled.samples.size(), ideal.samples.size());
  EXPECT_GT(scaled.states.front().bias.gyroscope_radps.norm(), 1e-3);
  for (std::size_t i = 0; i < ideal.samples.size(); ++i) {
    const ImuBias& bias = scaled.states[i].bias;
    const Vector3d rate =
        errors.gyroscope_gain * ideal.samples[i].angular_velocity_radps + bias.gyroscope_radps;
    const Vector3d force =
        errors.accelerometer_gain * ideal.samples[i].specific_force_mps2 + bias.accelerometer_mps2;
    EXPECT_LT((scaled.samples[i].angular_velocity_radps - rate).norm(), 1e-12);
    EXPECT_LT((scaled.samples[i].specific_force_mps2 - force).norm(), 1e-12);
  }
  errors = no_errors();
  errors.gyroscope_range_radps = 1.0;
  errors.accelerometer_range_mps2 = 9.0;
  double largest_rate = 0;
  double largest_force = 0;
  for (const ImuSample& sample : simulate_imu(body, 0, 4 * kSecond_ns, 200, errors, 1).samples) {
    largest_rate = std::max(largest_rate, sample.angular_velocity_radps.cwiseAbs().maxCoeff());
    largest_force = std::max(largest_force, sample.specific_force_mps2.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(largest_rate, 1.0);
  EXPECT_EQ(largest_force, 9.0);
}

TEST(ImuSensor, TimeOffsetMovesTheStampsAlone) {
  const PoseSpline body = motion_of(MotionPreset::slow, 2);
  ImuErrors errors;
  const SimulatedImu plain = simulate_imu(body, 0, kSecond_ns, 200, errors, 5);
  errors.time_offset_s = 0.0123;
  const SimulatedImu late = simulate_imu(body, 0, kSecond_ns, 200, errors, 5);
  ASSERT_EQ(plain.samples.size(), late.samples.size());
  for (std::size_t i = 0; i < plain.samples.size(); ++i) {
    EXPECT_EQ(late.samples[i].timestamp_ns - plain.samples[i].timestamp_ns, 12'300'000);
    EXPECT_EQ(late.samples[i].angular_velocity_radps, plain.samples[i].angular_velocity_radps);
    EXPECT_EQ(late.states[i].timestamp_ns, plain.states[i].timestamp_ns);
  }
}

TEST(ImuSensor, BiasesWalkAsTheirDensitySays) {
  // Increments of a random walk over 1 s have the density as their standard deviation.
  PoseSpline still(0, kSecond_ns, 20'000'000);
  ImuErrors errors;
  errors.sensor.noise = {0, 0, 2e-3, 3e-2};
  double gyroscope = 0;
  double accelerometer = 0;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const SimulatedImu imu = simulate_imu(still, 0, 60 * kSecond_ns, 200, errors, seed);
    for (std::size_t i = 200; i < imu.states.size(); i += 200) {
      const ImuBias& a = imu.states[i - 200].bias;
      const ImuBias& b = imu.states[i].bias;
      gyroscope += (b.gyroscope_radps - a.gyroscope_radps).squaredNorm();
      accelerometer += (b.accelerometer_mps2 - a.accelerometer_mps2).squaredNorm();
      count += 3;
    }
  }
  const double tolerance = 4 / std::sqrt(2.0 * count);
  EXPECT_NEAR(std::sqrt(gyroscope / count) / 2e-3, 1, tolerance);
  EXPECT_NEAR(std::sqrt(accelerometer / count) / 3e-2, 1, tolerance);
}

}  // namespace
}  // namespace fusebench
