// Bonn RGB-D Dynamic recordings (Palazzolo et al., ReFusion, IROS 2019): TUM's layout, another camera, and
// ground truth of another body.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::bonn {

/// A folder with TUM's lists whose name begins with "rgbd_bonn". With a calibration.toml in it, it is a
/// recording in TUM's format, whose poses are the camera's: one that was converted keeps its name.
[[nodiscard]] bool is_bonn(const std::filesystem::path& folder);

/// Poses of the published ground truth, T_mocap_markers, as those of the colour camera in the world of the
/// published model of the room: T_ros^-1 T_mocap_markers T_ros T_m, with the matrices of the recordings' page
/// and without the scale of 1.059 that T_m has.
[[nodiscard]] SE3 camera_in_model(const SE3& T_mocap_markers);

/// Opens rgb.txt, depth.txt (5000 a metre, registered), groundtruth.txt. Calibration: the options',
/// calibration.toml, else configs/recordings/bonn.toml. Pseudo ground truth beside it is of the camera
/// already and stays as it is. imu.csv is taken from beside. Errors: configuration, data_missing,
/// data_corrupt.
[[nodiscard]] Result<recording::Recording> open_bonn_rgbd(const std::filesystem::path& folder,
                                                          const recording::ReadOptions& options);

}  // namespace fusebench::formats::bonn
