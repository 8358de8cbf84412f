// TUM RGB-D recordings (Sturm et al., A benchmark for the evaluation of RGB-D SLAM systems, IROS 2012).
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::tum {

/// rgb.txt and depth.txt, or a list of pairs, lie in the folder.
[[nodiscard]] bool is_tum(const std::filesystem::path& folder);

/// Opens a folder with rgb.txt, depth.txt and, if present, groundtruth.txt, accelerometer.txt, and the files
/// that any format may have beside it (calibration.toml, imu.csv). Checks all lists, pairs colour with depth
/// by TUM's rule, and reads every used image once for the fingerprint. Images are undistorted when loaded.
/// Without rgb.txt or depth.txt, pairs are those of a list "seconds file seconds file" (associations.txt of
/// ORB-SLAM, in either order of colour and depth; any *assoc*.txt or fr*.txt).
/// Without calibration.toml the folder's name tells the camera. Errors: configuration (unknown camera, option
/// out of range), data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_tum_rgbd(const std::filesystem::path& folder,
                                                         const recording::ReadOptions& options);

}  // namespace fusebench::formats::tum
