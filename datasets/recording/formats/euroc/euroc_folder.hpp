// EuRoC MAV's folders (Burri et al., IJRR 2016; the "ASL format") with depth images beside the camera's.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::euroc {

/// mav0/cam0/data.csv, or cam0/data.csv, lies in the folder.
[[nodiscard]] bool is_euroc(const std::filesystem::path& folder);

/// cam0 (grey or colour) and depth0 are each data.csv ("timestamp [ns],filename"), data/ and sensor.yaml.
/// Calibration: the options', calibration.toml, else the sensor.yaml of each: T_BS (sensor to body),
/// resolution, intrinsics, radial-tangential distortion of cam0, noise and T_BS of imu0. depth0 without a
/// sensor.yaml, or with cam0's T_BS and intrinsics, is registered to cam0; depth_units_per_metre in it (no
/// key of EuRoC) is the value of one metre, 1000 without. imu0/data.csv is used if it is there, and
/// state_groundtruth_estimate0/data.csv (of the body; the first eight of its columns, or all 17) is the
/// ground truth, and the ground truth of states where the IMU is the body. cam1 and others are left alone.
/// Errors: configuration, data_missing (among them no depth0), data_corrupt.
[[nodiscard]] Result<recording::Recording> open_euroc(const std::filesystem::path& folder,
                                                      const recording::ReadOptions& options);

}  // namespace fusebench::formats::euroc
