// Trajectories as TUM text: "timestamp tx ty tz qx qy qz qw", one pose a line.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/types.hpp"

namespace fusebench {

/// Seconds with nine decimals, from integer nanoseconds (no double in between).
[[nodiscard]] std::string stamp_text(std::int64_t timestamp_ns);

/// The text of a trajectory: stamps with nine decimals, numbers with their shortest round trip, w of the
/// quaternion >= 0.
[[nodiscard]] std::string tum_text(const Trajectory& trajectory);

/// What to do with two rows of the same stamp.
enum class Duplicates { error, first, last };

/// Reads TUM text: blank lines and # comments are skipped, commas count as blanks, rows are sorted by time,
/// quaternions normalised. Errors name file:line: data_missing, or data_corrupt for a row that is not eight
/// finite numbers, a zero quaternion, or a duplicate stamp.
[[nodiscard]] Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file,
                                                     Duplicates duplicates = Duplicates::error);

}  // namespace fusebench
