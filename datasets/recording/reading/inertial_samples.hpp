// Gyroscope and accelerometer that were recorded apart become inertial samples.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::reading {

/// A sample of a gyroscope alone.
struct GyroscopeSample {
  std::int64_t timestamp_ns = 0;
  Vector3d angular_velocity_radps = Vector3d::Zero();
};

/// One inertial sample per gyroscope sample: the accelerometer, linear between its neighbours in time, exact
/// where it has the same stamp. Gyroscope samples without an accelerometer sample on both sides, or between
/// two that are more than 50 ms apart, are left out. Both lists strictly increase in time.
[[nodiscard]] std::vector<ImuSample> interpolate_accelerometer(
    std::span<const GyroscopeSample> gyroscope,
    std::span<const recording::AccelerometerSample> accelerometer);

/// The same into recording.imu and imu_source; what was left out is counted in a warning. source: for
/// messages. Error data_corrupt: nothing is left.
[[nodiscard]] Result<void> set_imu(const std::string& source, std::span<const GyroscopeSample> gyroscope,
                                   std::span<const recording::AccelerometerSample> accelerometer,
                                   recording::Recording& recording);

/// Rows of "timestamp x y z [...]"; `keep` sees each row whose stamp is new. The unit of time is found from
/// the spacing and noted. Devices repeat a sample now and then, which is counted and left out. Errors, with
/// file:line: data_missing, data_corrupt (a row, time that runs backwards, the unit).
[[nodiscard]] Result<void> for_each_new_sample(const std::filesystem::path& file, std::string_view columns,
                                               recording::Recording& recording, const io::StampedRow& keep);

/// Of the current row: x, y and z from column 1 (accelerometer: from the given one).
[[nodiscard]] Result<GyroscopeSample> gyroscope_sample(const io::TextTable& table, std::int64_t time_ns);
[[nodiscard]] Result<recording::AccelerometerSample> accelerometer_sample(const io::TextTable& table,
                                                                          std::int64_t time_ns,
                                                                          std::size_t column = 1);

/// A file of each sensor, "timestamp x y z" (more columns may stand behind; they are ignored), rad/s and
/// m/s^2. Fills recording.imu and imu_source. Errors as above.
[[nodiscard]] Result<void> read_gyroscope_and_accelerometer(const std::filesystem::path& gyroscope_file,
                                                            const std::filesystem::path& accelerometer_file,
                                                            recording::Recording& recording);

}  // namespace fusebench::reading
