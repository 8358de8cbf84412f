// OpenLORIS-Scene recordings (Shi et al., Are We Ready for Service Robots?, ICRA 2020): a RealSense D435i on
// a robot, whose ground truth is of the robot's base.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::open_loris {

/// Opens a folder with color.txt and aligned_depth.txt ("seconds name"; millimetres, registered to colour),
/// sensors.yaml, trans_matrix.yaml and, if present, groundtruth.txt (TUM columns, of base_link) and
/// d400_gyroscope.txt, d400_accelerometer.txt ("seconds x y z"). depth.txt, the fisheye cameras and the
/// odometry are left alone. The colour camera is d400_color_optical_frame; the IMU sits where
/// trans_matrix.yaml puts d400_gyroscope, and its noise is that of realsense_imu.hpp. Calibration: the
/// options', calibration.toml, else these files. Errors: configuration, data_missing, data_corrupt (among
/// them no chain of transforms from base_link to the camera).
[[nodiscard]] Result<recording::Recording> open_open_loris(const std::filesystem::path& folder,
                                                           const recording::ReadOptions& options);

}  // namespace fusebench::formats::open_loris
