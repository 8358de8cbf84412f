#include "core/estimator/filter/sensor_constants.hpp"

#include <algorithm>
#include <cmath>

namespace fusebench::filter {

std::vector<SensorConstant> sensor_constants(const GaussianState& state, const SensorTiming& timing) {
  const SensorErrors& errors = state.mean.sensors;
  std::vector<SensorConstant> constants;
  const auto add = [&](std::string name, double value) {
    const auto at = static_cast<Eigen::Index>(kImuTimeOffset + constants.size());
    constants.push_back({std::move(name), value, std::sqrt(std::max(0.0, state.covariance(at, at)))});
  };
  const auto add_axes = [&](const std::string& name, const std::string& unit, const Vector3d& values) {
    add(name + "_x" + unit, values.x());
    add(name + "_y" + unit, values.y());
    add(name + "_z" + unit, values.z());
  };
  add("imu_time_offset_s", state.mean.imu_time_offset_s);
  add_axes("imu_rotation", "_rad", errors.imu_rotation_rad);
  add_axes("gyroscope_scale", "", errors.gyroscope_scale);
  add_axes("accelerometer_scale", "", errors.accelerometer_scale);
  add("color_readout_s", timing.color_readout_s + errors.color_readout_s);
  add("depth_readout_s", timing.depth_readout_s + errors.depth_readout_s);
  add("depth_delay_s", timing.depth_delay_s + errors.depth_delay_s);
  return constants;
}

}  // namespace fusebench::filter
