// ICL-NUIM as its renderer wrote it: scene_00_<k>.png, .depth and .txt side by side.
//
// Positions and ray lengths are in units of the scene: metres for the living room and the office. The desk of
// the authors' earlier set (Handa et al., ECCV 2012) is in centimetres: depth_units_per_metre = 100.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/recording/read_options.hpp"
#include "datasets/recording/recording.hpp"

namespace fusebench::formats::icl {

/// Some scene_*.depth lies in the folder.
[[nodiscard]] bool is_icl_povray(const std::filesystem::path& folder);

/// Frames are the pairs scene_<nn>_<k>.png and .depth; an image without its partner is counted in a warning.
/// Truth is the camera file (.txt) of each frame that has one, in the renderer's world with y turned down.
/// depth_units_per_metre (default 1) scales ray lengths and positions. imu.csv and calibration.toml are taken
/// from beside. Errors: configuration, data_missing (no pair), data_corrupt.
[[nodiscard]] Result<recording::Recording> open_icl_povray(const std::filesystem::path& folder,
                                                           const recording::ReadOptions& options);

}  // namespace fusebench::formats::icl
