// "EXR + RGB" exports of the iOS app Record3D: colour images, LiDAR depth in metres, ARKit's poses.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::record3d {

/// metadata.json, rgb/ and depth/ lie in the folder, or in EXR_RGBD within it.
[[nodiscard]] bool is_record3d(const std::filesystem::path& folder);

/// rgb/<k>.jpg (or .png) and depth/<k>.exr are paired by number; depth is of colour's view, in as many pixels
/// or fewer, and what is no number is no measurement. metadata.json: w, h, K (column by column), poses ([qx,
/// qy, qz, qw, tx, ty, tz], camera to world, of a camera whose y is up and that looks along -z), fps or
/// frameTimestamps (seconds). Poses are ARKit's estimate, and labelled so; recordings of the front camera
/// have none. The camera is that of K unless the options or calibration.toml say otherwise; there are no
/// inertial samples in an export (imu.csv is taken from beside). Errors: configuration, data_missing,
/// data_corrupt.
[[nodiscard]] Result<recording::Recording> open_record3d(const std::filesystem::path& folder,
                                                         const recording::ReadOptions& options);

}  // namespace fusebench::formats::record3d
