// The lists of a TUM RGB-D folder (its ground truth: core/trajectory/trajectory_file.hpp). All readers demand
// strictly increasing time; errors name file:line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::tum {

struct ListedImage {
  std::int64_t timestamp_ns = 0;
  std::filesystem::path file;
};

/// rgb.txt, depth.txt: "timestamp filename", the name relative to the list's folder.
/// Errors: data_missing (the list or an image), data_corrupt (a row, the order in time, an empty list).
[[nodiscard]] Result<std::vector<ListedImage>> read_image_list(const std::filesystem::path& list);

/// accelerometer.txt: "timestamp ax ay az", m/s^2. Errors: data_missing, data_corrupt.
[[nodiscard]] Result<std::vector<recording::AccelerometerSample>> read_tum_accelerometer(
    const std::filesystem::path& file);

}  // namespace fusebench::formats::tum
