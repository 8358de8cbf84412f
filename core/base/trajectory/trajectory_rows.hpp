// Poses as they stand in a file, and the order that they are brought into.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/stamped_rows.hpp"
#include "core/base/types.hpp"

namespace fusebench::trajectory {

/// What to do with two rows of the same stamp.
enum class Duplicates {
  error,          ///< time must strictly increase, so rows out of order are errors too
  last_in_order,  ///< time must not run backwards; of rows in a row with one stamp, the last is kept
  none,           ///< rows are sorted by time; two of one stamp are an error
  first,          ///< rows are sorted by time; of one stamp, the first row of the file is kept
  last,           ///< the same with the last row, as the scripts of the TUM RGB-D benchmark do
  as_written,     ///< all rows in the order of the file, as evo does
  // Rows are sorted by time. While at most one in a hundred repeats a stamp (published ground truth has such
  // rows), the last one counts, or both; more are an error.
  rare_last,
  rare_kept,
};

/// The order in time that the rows of the file itself must have.
[[nodiscard]] io::TimeOrder order_for(Duplicates duplicates);

/// The rows of a file, in its order.
struct TrajectoryRows {
  Trajectory poses;
  std::vector<int> lines;    ///< of each pose
  std::size_t not_unit = 0;  ///< quaternions that were off unit length
  int first_not_unit_line = 0;
};

/// Squares of distances between positions within this, and sums of them, are numbers; in any unit of a
/// trajectory.
inline constexpr double kMostPosition = 1e12;

/// What is wrong with it, "translation 1e+13 0 0 (allowed: coordinates up to 1e+12)"; nothing if every
/// coordinate is within that.
[[nodiscard]] std::optional<std::string> coordinate_fault(std::string_view name, const Vector3d& position);

/// Error data_corrupt with file:line: a coordinate beyond that.
[[nodiscard]] Result<void> check_position(const io::TextTable& table, const Vector3d& position);

/// Adds the pose of a row; the quaternion is normalised. Error data_corrupt: its norm is near zero, or its
/// position beyond kMostPosition.
[[nodiscard]] Result<void> take_pose(const io::TextTable& table, std::int64_t time_ns,
                                     const Vector3d& translation_m, const Quaterniond& rotation,
                                     TrajectoryRows& rows);

/// The poses in the order that `duplicates` asks for. Warnings count quaternions off unit length by more than
/// a thousandth, and rows that were moved or dropped. Errors data_corrupt: two rows of one stamp, where that
/// is one; or rows that are to be sorted and look like two trajectories one after the other.
[[nodiscard]] Result<Trajectory> ordered(TrajectoryRows rows, Duplicates duplicates,
                                         const std::filesystem::path& file,
                                         std::vector<std::string>& warnings);

}  // namespace fusebench::trajectory
