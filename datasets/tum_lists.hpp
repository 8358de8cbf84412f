// The text files of a TUM RGB-D folder. All readers demand strictly increasing time; errors name file:line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/types.hpp"
#include "datasets/recording.hpp"

namespace fusebench {

struct ListedImage {
  std::int64_t timestamp_ns = 0;
  std::filesystem::path file;
};

/// rgb.txt, depth.txt: "timestamp filename", the name relative to the list's folder.
/// Errors: data_missing (the list or an image), data_corrupt (a row, the order in time, an empty list).
[[nodiscard]] Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list);

/// groundtruth.txt: "timestamp tx ty tz qx qy qz qw", metres; quaternions are normalised, and those that are
/// off by more than 1 % are counted in a warning. Errors: data_missing, data_corrupt (also a quaternion near
/// zero).
[[nodiscard]] Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings);

/// accelerometer.txt: "timestamp ax ay az", m/s^2. Errors: data_missing, data_corrupt.
[[nodiscard]] Result<std::vector<AccelerometerSample>> read_tum_accelerometer(
    const std::filesystem::path& file);

}  // namespace fusebench
