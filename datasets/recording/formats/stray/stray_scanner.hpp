// Recordings of the iOS app Stray Scanner (github.com/strayrobots/scanner): colour video, LiDAR depth with
// its confidence, ARKit's odometry and the raw IMU.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::stray {

/// odometry.csv and camera_matrix.csv lie in the folder.
[[nodiscard]] bool is_stray(const std::filesystem::path& folder);

/// rgb.mp4 is not decoded: its frames must have been extracted to rgb/<k>.png or .jpg, numbered from 0 as
/// depth/<k>.png is (16-bit millimetres, of colour's view in fewer pixels). The message says the command.
/// Depth of confidence/<k>.png 0 (low) is no measurement. odometry.csv has the times of frames and
/// T_world_camera of a camera with y down; it is ARKit's estimate, and labelled so. imu.csv is the app's own:
/// acceleration before rotation, seconds, in multiples of gravity or m/s^2, with Core Motion's sign.
/// Calibration: the options', calibration.toml, else the median of fx, fy, cx, cy in odometry.csv, with a
/// warning if the focal length changes, else camera_matrix.csv. Both are of the whole video (1920 pixels
/// wide) and are scaled to the images; without the place and noise of the IMU, its samples are
/// not used. Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_stray(const std::filesystem::path& folder,
                                                      const recording::ReadOptions& options);

}  // namespace fusebench::formats::stray
