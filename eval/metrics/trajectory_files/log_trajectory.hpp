// The .log files of Choi et al. 2015 (Redwood, Open3D): for each frame a line of three integers, the first
// one its number, and four lines of the pose of its camera in world, row by row.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory_files {

/// The number of a frame is its stamp in nanoseconds; numbers rise. Rotations are made orthonormal, and poses
/// of lost frames are left out; warnings say how far off rotations were, and count lost frames. Errors name
/// file:line: data_missing; data_corrupt for lines that are none of these, numbers that do not rise, a matrix
/// that is no rotation to a hundredth or whose last row is not 0 0 0 1, and a file that ends within a pose.
[[nodiscard]] Result<Trajectory> read_log_trajectory(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory_files
