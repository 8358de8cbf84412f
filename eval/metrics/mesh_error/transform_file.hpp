// A rigid transform as a file of numbers.
#pragma once

#include <filesystem>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::mesh_error {

/// Reads a 4x4 matrix, row by row on four lines (as CloudCompare writes it) or on one; the last row is
/// 0 0 0 1, and may be left out of several lines. Errors: data_missing; data_corrupt for another count, what
/// is no number, a last row of another kind, or a 3x3 part that is no rotation to a hundredth (a scale is not
/// rigid) or a translation beyond trajectory::kMostPosition.
[[nodiscard]] Result<SE3> read_transform(const std::filesystem::path& file);

}  // namespace fusebench::mesh_error
