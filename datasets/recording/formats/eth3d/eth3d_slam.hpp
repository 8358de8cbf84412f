// ETH3D SLAM recordings (Schoeps, Sattler, Pollefeys, BAD SLAM: Bundle Adjusted Direct RGB-D SLAM, CVPR
// 2019): synchronised cameras with a global shutter, depth from active stereo reprojected into the colour
// camera, an IMU, and motion-capture truth for the training recordings.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::eth3d {

/// Opens a folder with associated.txt ("time file time file", seconds), calibration.txt ("fx fy cx cy",
/// images are undistorted), depth images with 5000 a metre, and, if present, groundtruth.txt (seconds, colour
/// camera) and imu.txt ("time wx wy wz ax ay az", seconds, rad/s, m/s^2: the IMU of the colour camera). The
/// lists rgb.txt and depth.txt are not needed. Inertial samples are only used with a calibration.toml that
/// says where the IMU sits, since the recording's own files do not: ETH3D publishes that apart
/// (camera_imu_calib_radtan.zip, Kalibr's T_cam_imu). Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_eth3d_slam(const std::filesystem::path& folder,
                                                           const recording::ReadOptions& options);

}  // namespace fusebench::formats::eth3d
