// A strapped-down inertial sensor with errors, on a body whose motion is a spline.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"
#include "datasets/synthetic_imu/synthetic_imu.hpp"

namespace fusebench::simulator::sensors {

/// Sensor model: measured = gain * true + bias + noise, cut off at the range.
struct ImuErrors {
  synthetic_imu::ImuSensor sensor = synthetic_imu::zr300_imu();  ///< noise, random walks, initial biases
  Matrix3d gyroscope_gain = Matrix3d::Identity();      ///< scale factors and misalignment of the axes
  Matrix3d accelerometer_gain = Matrix3d::Identity();  ///< the same
  double gyroscope_range_radps = radians(1000.0);  ///< a setting of the ZR300's BMI055 (125 to 2000 deg/s)
  double accelerometer_range_mps2 = 8 * kGravity_mps2;  ///< also (2 to 16 g)
  double time_offset_s = 0;  ///< the IMU's stamp minus the images' stamp of the same instant
};

/// The body's true state at one sample.
struct ImuState {
  std::int64_t timestamp_ns = 0;  ///< on the images' clock
  synthetic_imu::Kinematics motion;
  synthetic_imu::ImuBias bias;
};

struct SimulatedImu {
  std::vector<ImuSample> samples;  ///< on the IMU's clock
  std::vector<ImuState> states;    ///< one a sample
};

/// Samples from begin_ns (images' clock) to at least end_ns. Gravity is -9.81 m/s^2 along z of the world. The
/// same seed gives the same samples.
[[nodiscard]] SimulatedImu simulate_imu(const synthetic_imu::PoseSpline& body, std::int64_t begin_ns,
                                        std::int64_t end_ns, double rate_hz, const ImuErrors& errors,
                                        std::uint64_t seed);

}  // namespace fusebench::simulator::sensors
