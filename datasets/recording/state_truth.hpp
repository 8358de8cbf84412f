// True states of the IMU as text, in the columns that EuRoC's state_groundtruth_estimate0 has.
#pragma once

#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "core/estimator/filter/stamped_state.hpp"

namespace fusebench::recording {

/// "timestamp [ns], position [m], attitude (w x y z), velocity [m/s], gyroscope bias [rad/s], accelerometer
/// bias [m/s^2]": position, attitude and velocity of the IMU in the ground truth's world, biases in the IMU
/// frame. Quaternions are normalised. Errors name file:line: data_missing; data_corrupt (a row, the order in
/// time, a quaternion that is off unit length by more than 1 %).
[[nodiscard]] Result<std::vector<filter::StampedState>> read_state_truth(const std::filesystem::path& file);

}  // namespace fusebench::recording
