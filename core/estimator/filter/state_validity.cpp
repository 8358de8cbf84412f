#include "core/estimator/filter/state_validity.hpp"

#include <cmath>

namespace fusebench::filter {

namespace {

/// False for NaN too.
bool within(const auto& values, double largest) { return (values.array().abs() <= largest).all(); }

bool is_valid(const SensorErrors& errors) {
  return within(errors.imu_rotation_rad, kMaxMean) && within(errors.gyroscope_scale, kMaxScale) &&
         within(errors.accelerometer_scale, kMaxScale) && within(errors.timing_s(), kMaxTiming_s);
}

}  // namespace

bool is_valid(const GaussianState& state) {
  const FilterState& x = state.mean;
  const auto is_valid_pose = [](const SE3& T) {
    return within(T.rotation.coeffs(), kMaxMean) && within(T.translation, kMaxMean);
  };
  return is_valid_pose(x.T_world_imu) && within(x.velocity_world_mps, kMaxMean) &&
         within(x.gyroscope_bias_radps, kMaxMean) && within(x.accelerometer_bias_mps2, kMaxMean) &&
         within(x.gravity_direction_world, kMaxMean) && within(x.angular_velocity_imu_radps, kMaxMean) &&
         std::abs(x.imu_time_offset_s) <= kMaxMean && is_valid(x.sensors) &&
         is_valid_pose(x.T_world_imu_reference) && within(x.reference_rate, kMaxMean) &&
         within(x.reference_offset, kMaxMean) && within(x.model_offset, kMaxMean) &&
         within(x.reference_rate_offset, kMaxMean) && within(x.model_rate_offset, kMaxMean) &&
         within(x.model_readout.rate, kMaxMean) && within(x.model_readout.by_readout, kMaxMean) &&
         within(x.model_readout.by_delay, kMaxMean) && within(state.covariance, kMaxVariance);
}

}  // namespace fusebench::filter
