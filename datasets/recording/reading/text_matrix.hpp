// Matrices as text files: one row a line.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/geometry.hpp"
#include "core/base/types.hpp"

namespace fusebench::reading {

/// Row by row; a number that is missing or infinite (io/row_text.hpp) is a NaN. Errors name file:line:
/// data_missing, data_corrupt (another number of rows or columns, what is no number).
[[nodiscard]] Result<std::vector<double>> read_matrix(const std::filesystem::path& file, std::size_t rows,
                                                      std::size_t columns);

/// A 4x4 matrix [R t; 0 0 0 1] in metres; nothing if some number of it is none, as programs write for a frame
/// that they lost. Errors: those of read_matrix; data_corrupt (no rigid transform).
[[nodiscard]] Result<std::optional<SE3>> read_pose_matrix(const std::filesystem::path& file);

/// The pinhole camera of a 3x3 matrix K; its size stays 0. Errors: those of read_matrix; data_corrupt (focal
/// lengths that are not positive, skew, a last row that is not 0 0 1).
[[nodiscard]] Result<PinholeCamera> read_camera_matrix(const std::filesystem::path& file);

/// As above of the numbers of K, row by row; `place` begins the message.
[[nodiscard]] Result<PinholeCamera> camera_of_matrix(std::span<const double> K, const std::string& place);

}  // namespace fusebench::reading
