#include "datasets/simulator/sensors/imu_sensor.hpp"

#include <cmath>

namespace fusebench::simulator::sensors {

namespace {

Vector3d saturated(const Vector3d& value, double range) { return value.cwiseMax(-range).cwiseMin(range); }

}  // namespace

SimulatedImu simulate_imu(const synthetic_imu::PoseSpline& body, std::int64_t begin_ns, std::int64_t end_ns,
                          double rate_hz, const ImuErrors& errors, std::uint64_t seed) {
  SimulatedImu imu;
  imu.samples = synthetic_imu::ideal_imu(body, begin_ns, end_ns, rate_hz, {0, 0, -kGravity_mps2});
  for (ImuSample& sample : imu.samples) {
    sample.angular_velocity_radps = errors.gyroscope_gain * sample.angular_velocity_radps;
    sample.specific_force_mps2 = errors.accelerometer_gain * sample.specific_force_mps2;
  }
  const std::vector<synthetic_imu::ImuBias> biases =
      synthetic_imu::add_imu_noise(imu.samples, errors.sensor, rate_hz, seed);
  const std::int64_t offset_ns = std::llround(1e9 * errors.time_offset_s);
  imu.states.reserve(imu.samples.size());
  for (std::size_t i = 0; i < imu.samples.size(); ++i) {
    ImuSample& sample = imu.samples[i];
    imu.states.push_back({sample.timestamp_ns, body.evaluate(sample.timestamp_ns), biases[i]});
    sample.angular_velocity_radps = saturated(sample.angular_velocity_radps, errors.gyroscope_range_radps);
    sample.specific_force_mps2 = saturated(sample.specific_force_mps2, errors.accelerometer_range_mps2);
    sample.timestamp_ns += offset_ns;
  }
  return imu;
}

}  // namespace fusebench::simulator::sensors
