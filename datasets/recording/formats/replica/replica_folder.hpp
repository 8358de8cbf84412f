// Replica's rooms as rendered by NICE-SLAM (Zhu et al., CVPR 2022; iMAP's trajectories).
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::replica {

/// Some results/depth<digits>.png lies in the folder, and cam_params.json in it or in the folder above.
[[nodiscard]] bool is_replica(const std::filesystem::path& folder);

/// results/frame<k>.jpg (or .png) and results/depth<k>.png are paired by number. There are no stamps: frame k
/// is at k / frame rate. traj.txt has the pose of frame k (camera to world, x right, y down, z forward) as 16
/// numbers, a 4x4 matrix row by row, in row k. Calibration: the options', calibration.toml, else
/// cam_params.json, {"camera": {"w", "h", "fx", "fy", "cx", "cy", "scale"}}, in the folder or the one above:
/// scale is the value of one metre, and images are taken at an instant. Without traj.txt groundtruth.txt is
/// used. imu.csv is taken from beside. Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_replica(const std::filesystem::path& folder,
                                                        const recording::ReadOptions& options);

}  // namespace fusebench::formats::replica
