// The list of a TUM RGB-D folder that others do not have (its images:
// datasets/recording/reading/image_list.hpp; its ground truth: core/base/trajectory/trajectory_file.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::tum {

/// accelerometer.txt: "timestamp ax ay az", m/s^2, in strictly increasing time. Stamps count as those of
/// image lists do. Errors name file:line: data_missing, data_corrupt.
[[nodiscard]] Result<std::vector<recording::AccelerometerSample>> read_tum_accelerometer(
    const std::filesystem::path& file, std::vector<std::string>& warnings);

}  // namespace fusebench::formats::tum
