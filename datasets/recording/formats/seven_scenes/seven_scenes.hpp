// 7-Scenes recordings (Shotton et al., Scene Coordinate Regression Forests for Camera Relocalization in RGB-D
// Images, CVPR 2013), and those of others in the same layout (3DMatch).
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::seven_scenes {

/// Some frame-<digits>.depth.png lies in the folder.
[[nodiscard]] bool is_seven_scenes(const std::filesystem::path& folder);

/// Frames are the pairs frame-<k>.color.png (or .jpg) and .depth.png (millimetres; 0 and 65535: none); an
/// image without its partner is counted in a warning. There are no stamps: frame k is at k / frame_rate_hz.
///
/// Depth is in a camera of its own, and frame-<k>.pose.txt (4x4, camera to world) is that camera's, tracked
/// by KinectFusion in the same images. Calibration: the options', calibration.toml, else
/// configs/recordings/seven_scenes.toml. Where camera-intrinsics.txt (3x3) lies in the folder and is not that
/// of 7-Scenes' depth, the recording is one of 3DMatch's, whose depth is that of colour's pixels.
/// imu.csv is taken from beside. Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_seven_scenes(const std::filesystem::path& folder,
                                                             const recording::ReadOptions& options);

}  // namespace fusebench::formats::seven_scenes
