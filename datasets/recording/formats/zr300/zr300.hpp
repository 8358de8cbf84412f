// Recordings of an Intel RealSense ZR300: FMDataset (Zhu and Xu, Real-time Indoor Scene Reconstruction with
// RGBD and Inertia Input, ICME 2019; https://github.com/zhuzunjie17/FastFusion), as it is published and as
// its recorder writes it.
//
// Depth is in a camera of its own, 57 mm beside the colour camera; frames have it registered to colour.
// Inertial samples are those of IMU.txt, else of GYRO.txt and ACCEL.txt, else of imu.csv. The calibration is
// that of calibration.toml, else of calib.txt in the folder or the one above, else the published one of
// FMDataset's device; the notes say which.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::zr300 {

/// Opens a folder with TIMESTAMP.txt, color/, depth/ (options.filtered_depth: filtered/) and the files beside
/// them. Errors: configuration (calibration, option out of range), data_missing, data_corrupt (a list; a
/// unit of time that cannot be told; an IMU or truth that does not overlap the images in time).
[[nodiscard]] Result<recording::Recording> open_zr300(const std::filesystem::path& folder,
                                                      const recording::ReadOptions& options);

/// The same with COLOR.txt and DEPTH.txt, which are paired by time (see image_pairs.hpp).
[[nodiscard]] Result<recording::Recording> open_zr300_raw(const std::filesystem::path& folder,
                                                          const recording::ReadOptions& options);

}  // namespace fusebench::formats::zr300
