// Folders that ScanNet's SensReader exports from a .sens file (Dai et al., CVPR 2017).
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::scannet {

/// color/, depth/ and intrinsic/intrinsic_depth.txt (or intrinsic_depth.txt) lie in the folder.
[[nodiscard]] bool is_scannet(const std::filesystem::path& folder);

/// color/<k>.jpg (or .png), depth/<k>.png (millimetres) and pose/<k>.txt (4x4, of the depth camera, in
/// metres) are paired by number; the export keeps no stamps: frame k is at k / frame rate. Calibration: the
/// options', calibration.toml, else intrinsic_color.txt and intrinsic_depth.txt (4x4), and
/// extrinsic_color.txt and extrinsic_depth.txt if they are there (4x4, camera to device); without
/// intrinsic_color.txt one camera is for both. Depth of another camera than colour's is registered. Poses are
/// BundleFusion's estimate, and labelled so; without any, groundtruth.txt is used. imu.csv is taken from
/// beside. Errors: configuration, data_missing, data_corrupt.
[[nodiscard]] Result<recording::Recording> open_scannet(const std::filesystem::path& folder,
                                                        const recording::ReadOptions& options);

}  // namespace fusebench::formats::scannet
