// A strapdown inertial sensor with errors, on a body with a spline motion.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/synthetic_imu/pose_spline.hpp"
#include "datasets/synthetic_imu/synthetic_imu.hpp"

namespace fusebench::simulator::sensors {

/// Sensor model: measured = gain * true + bias + noise, clipped to the range.
struct ImuErrors {
  synthetic_imu::ImuSensor sensor = synthetic_imu::zr300_imu();  ///< noise, random walks, initial biases
  Matrix3d gyroscope_gain = Matrix3d::Identity();       ///< scale factors and misalignment of the axes
  Matrix3d accelerometer_gain = Matrix3d::Identity();   ///< the same
  double gyroscope_range_radps = radians(1000.0);       ///< ZR300's BMI055 (settings: 125 to 2000 deg/s)
  double accelerometer_range_mps2 = 8 * kGravity_mps2;  ///< ZR300's BMI055 (settings: 2 to 16 g)
  double time_offset_s = 0;                             ///< IMU stamp minus image stamp at the same instant
};

/// True state of the body at a sample.
struct ImuState {
  std::int64_t timestamp_ns = 0;  ///< on the images' clock
  synthetic_imu::Kinematics motion;
  synthetic_imu::ImuBias bias;
};

struct SimulatedImu {
  std::vector<ImuSample> samples;  ///< on the IMU's clock
  std::vector<ImuState> states;    ///< one for each sample
};

/// Samples from begin_ns (image clock) to at least end_ns. Gravity is -9.81 m/s^2 along world z.
/// Deterministic for a seed.
[[nodiscard]] SimulatedImu simulate_imu(const synthetic_imu::PoseSpline& body, std::int64_t begin_ns,
                                        std::int64_t end_ns, double rate_hz, const ImuErrors& errors,
                                        std::uint64_t seed);

}  // namespace fusebench::simulator::sensors
