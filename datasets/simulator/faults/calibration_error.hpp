// An error of the extrinsic calibration of the colour camera to the IMU.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"

namespace fusebench::simulator::faults {

/// Deviation of calibration.toml from the ground truth, in random directions by the seed.
struct CalibrationError {
  double rotation_deg = 0;  ///< 0 to 45
  double shift_cm = 0;      ///< 0 to 50

  [[nodiscard]] bool is_zero() const { return rotation_deg == 0 && shift_cm == 0; }
};

/// DEG:CM, e.g. "1:2". Error usage.
[[nodiscard]] Result<CalibrationError> parse_calibration_error(std::string_view text);

/// Error configuration: out of range.
[[nodiscard]] Result<void> check_calibration_error(const CalibrationError& error);

/// The wrong T_imu_camera: rotated about a random axis, with a shifted translation. Without an error, the
/// true one unchanged.
[[nodiscard]] SE3 miscalibrated(const SE3& T_imu_camera, const CalibrationError& error, std::uint64_t seed);

}  // namespace fusebench::simulator::faults
