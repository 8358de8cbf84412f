// trans_matrix.yaml of OpenLORIS-Scene.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "datasets/calibration/frame_tree.hpp"

namespace fusebench::formats::open_loris {

/// "trans_matrix: - child_frame, parent_frame, matrix.data (4x4, T_parent_child)". Errors name file:line:
/// data_missing, data_corrupt.
[[nodiscard]] Result<calibration::FrameTree> read_transforms(const std::filesystem::path& file);

}  // namespace fusebench::formats::open_loris
