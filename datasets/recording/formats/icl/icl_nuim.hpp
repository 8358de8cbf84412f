// ICL-NUIM recordings (Handa et al., A Benchmark for RGB-D Visual Odometry, 3D Reconstruction and SLAM, ICRA
// 2014), in both packings: "TUM RGB-D compatible PNGs", read here, and POV-Ray's own files (icl_povray.hpp).
//
// TUM-compatible: associations.txt ("index file index file", depth first), rgb/<k>.png, depth/<k>.png
// (z-depth, 5000 a metre), and poses "index tx ty tz qx qy qz qw" in *.gt.freiburg. Rows of the two files are
// not parallel: poses begin at index 1, images at 0. So images and poses are matched by index.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::icl {

/// The folder holds either packing. TUM-compatible: associations.txt and either a *.gt.freiburg or a first
/// row that counts frames and names images by the same number (a TUM recording with a list of the same name
/// has times there). POV-Ray: some scene_*.depth.
[[nodiscard]] bool is_icl_nuim(const std::filesystem::path& folder);

/// Opens either packing. The clean and the noisy variants differ in their images only.
/// Truth: the one *.gt.freiburg of the folder; without it groundtruth.txt, which then counts frames as well
/// (unlike groundtruth.txt beside recordings of other formats, whose first column is seconds), and is
/// reflected as well. Frames without a pose stay frames. imu.csv and calibration.toml are taken from beside.
/// Errors: configuration, data_missing, data_corrupt (a row, an index that is no whole number, images of
/// different indices in one row, indices that do not increase, several *.gt.freiburg).
[[nodiscard]] Result<recording::Recording> open_icl_nuim(const std::filesystem::path& folder,
                                                         const recording::ReadOptions& options);

}  // namespace fusebench::formats::icl
