// Folders of Open3D's recorders (Zhou, Park, Koltun, 2018): what its tools write for Azure Kinect and
// RealSense cameras, and what its reconstruction system reads.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::open3d {

/// intrinsic.json or camera_intrinsic.json, color/ and depth/ lie in the folder.
[[nodiscard]] bool is_open3d(const std::filesystem::path& folder);

/// color/<k>.jpg (or .png) and depth/<k>.png, registered to colour, are paired by number. The camera is that
/// of intrinsic.json (width, height, intrinsic_matrix column by column), unless the options or
/// calibration.toml say otherwise. Value of one metre: depth_scale of config.json, 1000 without. Times:
/// frame_times.txt ("number seconds") if it is there, else frame k is at k / frame_rate_hz. groundtruth.txt
/// and imu.csv are taken from beside. Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_open3d(const std::filesystem::path& folder,
                                                       const recording::ReadOptions& options);

}  // namespace fusebench::formats::open3d
