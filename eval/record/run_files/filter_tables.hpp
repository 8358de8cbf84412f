// nees.csv and states.csv: the consistency of a run's filter and its states, frame by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/estimator/health/frame_report.hpp"
#include "eval/record/record.hpp"

namespace fusebench::run_files {

/// Columns capture_timestamp, part (of kStateParts), nees_per_dof; by part, then in order of time. Empty if
/// no part has a value.
[[nodiscard]] std::string nees_table(const record::RecordedNees& nees);

struct NeesTableRow {
  std::int64_t capture_ns = 0;
  std::string part;
  double nees_per_dof = 0;
};

/// Errors: data_missing; data_corrupt for what is no such table.
[[nodiscard]] Result<std::vector<NeesTableRow>> read_nees_table(const std::filesystem::path& file);

/// A row per frame: capture instant (seconds, nine decimals), status; means of the pose of the IMU in world
/// (m, quaternion w x y z), velocity (m/s, world), biases of gyroscope (rad/s) and accelerometer (m/s^2), and
/// the direction of gravity; then the upper triangle, row by row, of the covariance of rotation, position,
/// velocity and biases (perturbations as in core/estimator/filter/filter_state.hpp): column P_2_5 is row 2,
/// column 5, from 0; last the constants of the sensors (filter::sensor_constants()), each with its standard
/// deviation.
[[nodiscard]] std::string state_table_header();
[[nodiscard]] std::string state_table_row(const health::FrameReport& report, const SensorTiming& timing);

}  // namespace fusebench::run_files
