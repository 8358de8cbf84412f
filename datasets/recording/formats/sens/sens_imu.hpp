// Inertial frames of .sens files as samples in SI units.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/base/error.hpp"
#include "datasets/recording/image_logs/sens_log.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::sens {

/// Fills recording.imu and imu_source. The frames are Core Motion's: gravity and the user's acceleration
/// apart, in multiples of 9.80665 m/s^2, so that the specific force is -(acceleration + gravity); rates in
/// rad/s. That gravity has unit length is checked: otherwise they are not used, nor are those whose
/// stamps do not rise, with a warning. nanoseconds_per_unit: of the file's stamps. Error data_corrupt: a
/// value beyond the limits of sensor_columns.hpp.
[[nodiscard]] Result<void> take_imu_frames(const std::filesystem::path& file,
                                           std::span<const image_logs::SensImuFrame> frames,
                                           std::int64_t nanoseconds_per_unit,
                                           recording::Recording& recording);

}  // namespace fusebench::formats::sens
