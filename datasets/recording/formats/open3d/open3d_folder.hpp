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
/// calibration.toml say otherwise. Value of one metre: depth_scale of intrinsic.json, else that of
/// config.json, else 1000. Times: frame_times.txt ("number seconds") if it is there, else frame k is at k /
/// rate, the rate being the options', fps of intrinsic.json, or 30 Hz. Other keys of intrinsic.json are named
/// in a warning. groundtruth.txt and imu.csv are taken from beside. Errors: configuration, data_missing,
/// data_corrupt.
[[nodiscard]] Result<recording::Recording> open_open3d(const std::filesystem::path& folder,
                                                       const recording::ReadOptions& options);

}  // namespace fusebench::formats::open3d
