// Trajectories as TUM text: "timestamp tx ty tz qx qy qz qw", one pose a line; seconds and metres.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/trajectory/trajectory_rows.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory {

/// Seconds with nine decimals, from integer nanoseconds (no double in between).
[[nodiscard]] std::string stamp_text(std::int64_t timestamp_ns);

/// The text of a trajectory: stamps with nine decimals, numbers with their shortest round trip, w of the
/// quaternion >= 0.
[[nodiscard]] std::string tum_text(const Trajectory& trajectory);

/// Reads TUM text (blank lines, # comments and commas as in TextTable). A line of names before the rows says
/// which columns are which, and in which unit stamps count (pose_head.hpp); else these are the first eight,
/// and the unit is by the size of the first stamp. Rows of lost frames are left out (pose_table.hpp).
/// Quaternions are normalised; rows are ordered as ordered() does. Warnings say what was not used or guessed.
///
/// Errors name file:line: data_missing, or data_corrupt for a row that is no stamp with seven finite numbers,
/// a quaternion near zero, the order in time (see Duplicates), or a file without poses; those of
/// read_pose_head().
[[nodiscard]] Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings,
                                                     Duplicates duplicates = Duplicates::error);

}  // namespace fusebench::trajectory
