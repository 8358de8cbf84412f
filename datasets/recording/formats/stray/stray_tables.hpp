// The CSV files of Stray Scanner: a line of names, then rows.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::stray {

struct StrayFrame {
  std::int64_t index = 0;
  std::int64_t timestamp_ns = 0;
  SE3 T_world_camera;
  std::optional<PinholeCamera> camera;  ///< of the video, without its size; of newer versions of the app
};

/// odometry.csv: "timestamp, frame, x, y, z, qx, qy, qz, qw", of newer versions of the app also "fx, fy, cx,
/// cy", which a row may leave empty. Other columns that have values are named in `warnings` as not used.
/// Numbers and times both rise. Errors name file:line: data_missing, data_corrupt.
[[nodiscard]] Result<std::vector<StrayFrame>> read_stray_odometry(const std::filesystem::path& file,
                                                                  std::vector<std::string>& warnings);

/// imu.csv: "timestamp, a_x, a_y, a_z, alpha_x, alpha_y, alpha_z". Core Motion reports accelerations in
/// multiples of 9.80665 m/s^2, and gravity downwards: at rest on a table z is -1, where an accelerometer
/// feels +9.8 m/s^2. So the specific force is the negative. Versions of the app that write m/s^2 are known by
/// the median length; one that is neither gets no samples and a warning. Rows whose time repeats are left
/// out. Errors as above.
[[nodiscard]] Result<void> read_stray_imu(const std::filesystem::path& file, recording::Recording& recording);

}  // namespace fusebench::formats::stray
