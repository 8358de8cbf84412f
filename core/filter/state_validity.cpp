#include "core/filter/state_validity.hpp"

#include <cmath>

namespace fusebench::filter {

namespace {

/// False for what is not a number as well.
bool within(const auto& values, double largest) { return (values.array().abs() <= largest).all(); }

}  // namespace

bool is_valid(const GaussianState& state) {
  const FilterState& x = state.mean;
  const auto is_valid_pose = [](const SE3& T) {
    return within(T.rotation.coeffs(), kLargestMean) && within(T.translation, kLargestMean);
  };
  return is_valid_pose(x.T_world_imu) && within(x.velocity_world_mps, kLargestMean) &&
         within(x.gyroscope_bias_radps, kLargestMean) && within(x.accelerometer_bias_mps2, kLargestMean) &&
         within(x.gravity_direction_world, kLargestMean) &&
         within(x.angular_velocity_imu_radps, kLargestMean) &&
         std::abs(x.imu_time_offset_s) <= kLargestMean && is_valid_pose(x.T_world_imu_reference) &&
         within(x.reference_offset, kLargestMean) && within(x.model_offset, kLargestMean) &&
         within(state.covariance, kLargestVariance);
}

}  // namespace fusebench::filter
