// states.csv: what the filter knew after each frame, for statistics of a user's own.
#pragma once

#include <string>

#include "core/health/frame_report.hpp"

namespace fusebench::run_files {

/// A row per frame: capture instant (seconds, nine decimals), status; means of the pose of the IMU in world
/// (m, quaternion w x y z), velocity (m/s, world), biases of gyroscope (rad/s) and accelerometer (m/s^2), and
/// the direction of gravity; then the upper triangle, row by row, of the covariance of rotation, position,
/// velocity and biases (perturbations as in core/filter/filter_state.hpp): column P_2_5 is row 2, column 5,
/// from 0; last the constants of the sensors (filter::sensor_constants()), each with its standard deviation.
[[nodiscard]] std::string state_table_header();
[[nodiscard]] std::string state_table_row(const health::FrameReport& report, const SensorTiming& timing);

}  // namespace fusebench::run_files
