// Trajectories as TUM text: "timestamp tx ty tz qx qy qz qw", one pose a line; seconds and metres.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/types.hpp"

namespace fusebench {

/// Seconds with nine decimals, from integer nanoseconds (no double in between).
[[nodiscard]] std::string stamp_text(std::int64_t timestamp_ns);

/// The text of a trajectory: stamps with nine decimals, numbers with their shortest round trip, w of the
/// quaternion >= 0.
[[nodiscard]] std::string tum_text(const Trajectory& trajectory);

/// What to do with two rows of the same stamp.
enum class Duplicates {
  error,          ///< time must strictly increase, so rows out of order are errors too
  last_in_order,  ///< time must not run backwards; of rows in a row with one stamp, the last is kept
  first,          ///< rows are sorted by time; of one stamp, the first row of the file is kept
  last,           ///< the same with the last row, as the scripts of the TUM RGB-D benchmark do
  as_written,     ///< all rows in the order of the file, as evo does
};

/// Reads TUM text (blank lines, # comments and commas as in TextTable). Quaternions are normalised. Warnings
/// count those that were off unit length by more than 1 %, and rows that were moved or dropped. Errors name
/// file:line: data_missing, or data_corrupt for a row that is not eight finite numbers, a quaternion near
/// zero, the order in time (see Duplicates), or a file without rows.
[[nodiscard]] Result<Trajectory> read_tum_trajectory(const std::filesystem::path& file,
                                                     std::vector<std::string>& warnings,
                                                     Duplicates duplicates = Duplicates::error);

}  // namespace fusebench
