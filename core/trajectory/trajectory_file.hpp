// Trajectories as TUM text: "timestamp tx ty tz qx qy qz qw", one pose a line; seconds and metres.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/types.hpp"
#include "core/io/text_table.hpp"
#include "core/trajectory/trajectory_rows.hpp"

namespace fusebench::trajectory {

/// Seconds with nine decimals, from integer nanoseconds (no double in between).
[[nodiscard]] std::string stamp_text(std::int64_t timestamp_ns);

/// The text of a trajectory: stamps with nine decimals, numbers with their shortest round trip, w of the
/// quaternion >= 0.
[[nodiscard]] std::string tum_text(const Trajectory& trajectory);

/// Reads TUM text, whose stamps count in `unit` (blank lines, # comments and commas as in TextTable).
/// Quaternions are normalised; rows are ordered as ordered() does, with its warnings. Errors name file:line:
/// data_missing, or data_corrupt for a row that is not eight finite numbers, a quaternion near zero, the
/// order in time (see Duplicates), or a file without rows.
[[nodiscard]] Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings,
                                                     Duplicates duplicates = Duplicates::error,
                                                     io::TimeUnit unit = io::TimeUnit::seconds);

}  // namespace fusebench::trajectory
