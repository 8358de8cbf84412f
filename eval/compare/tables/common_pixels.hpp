// The AIE of finished runs on the pixels that they share, from their files of intensity differences.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "core/base/error.hpp"
#include "eval/metrics/intensity_metrics.hpp"

namespace fusebench::tables {

/// One summary per file, in order. Reads all files side by side, a frame at a time. Errors: those of
/// IntensityReader; data_corrupt if the files differ in image size, in the number of frames or in a stamp
/// (other recordings or windows).
[[nodiscard]] Result<std::vector<metrics::IntensitySummary>> common_pixel_error(
    std::span<const std::filesystem::path> files);

}  // namespace fusebench::tables
