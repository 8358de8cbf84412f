// Poses as matrices, one a row, as in the files of KITTI, KITTI-360 and Replica.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/pose_head.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"
#include "eval/metrics/trajectory_files/trajectory_formats.hpp"

namespace fusebench::trajectory_files {

/// Columns of a matrix: 3x4 or 4x4 numbers, row by row, perhaps after a stamp or the number of the frame.
struct MatrixLayout {
  PoseKey key = PoseKey::order;
  bool is_transposed = false;  ///< 4x4, with the translation in the last row
  bool is_surely_one =
      false;  ///< the first rows have unit rows of a rotation, and 0 0 0 1 where they are 4x4

  [[nodiscard]] std::string described() const;  ///< "", ", after the number of the frame"
};

/// The rows have 3x4 poses from column `first` on.
[[nodiscard]] bool has_rotations(std::span<const trajectory::HeadRow> rows, std::size_t first);

/// By the first rows: 12, 13, 16 or 17 columns; 4x4 with 0 0 0 1 as the last row or column of each. A first
/// column of rising whole numbers below 1e7 is the frame's number unless its unit of time is given, any other
/// one a stamp. Nothing of other rows.
[[nodiscard]] std::optional<MatrixLayout> matrix_layout(const trajectory::PoseHead& head, bool unit_is_given);

/// Poses without a key have the number of their row as the stamp in nanoseconds; where rows of lost frames
/// are left out, the key is the number of the frame. Warnings: transposed matrices, those of PoseMatrices and
/// of trajectory::ordered(). Errors name file:line: data_missing; data_corrupt for a row that is no pose,
/// numbers that do not rise, those of ordered().
[[nodiscard]] Result<LoadedTrajectory> read_matrix_rows(const std::filesystem::path& file,
                                                        const MatrixLayout& layout, io::TimeUnit unit,
                                                        trajectory::Duplicates duplicates,
                                                        std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory_files
