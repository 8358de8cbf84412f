// Which columns of a table are a pose and its stamp, by their names.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"

namespace fusebench::trajectory {

/// Columns count from 0.
struct PoseColumns {
  std::size_t stamp = 0;
  std::array<std::size_t, 3> position = {1, 2, 3};
  std::array<std::size_t, 4> quaternion = {4, 5, 6, 7};  ///< of x, y, z, w
  std::optional<io::TimeUnit> unit = {};                 ///< of the stamp, if it is named
  std::optional<std::size_t> fraction = {};              ///< of the time beyond the seconds in `stamp`
  io::TimeUnit fraction_unit = io::TimeUnit::nanoseconds;
  double metres_per_unit = 1;  ///< of the position

  /// How many columns a row needs.
  [[nodiscard]] std::size_t needed() const;
  [[nodiscard]] bool w_is_first() const { return quaternion[3] < quaternion[0]; }
  /// The stamp, position and quaternion are in these columns as well.
  [[nodiscard]] bool same_places(const PoseColumns& other) const;
};

inline constexpr PoseColumns kTumColumns;
/// As messages of ROS print them: whole seconds, and the nanoseconds beyond them.
inline constexpr PoseColumns kSplitStampColumns{
    .position = {2, 3, 4}, .quaternion = {5, 6, 7, 8}, .unit = io::TimeUnit::seconds, .fraction = 1};
inline constexpr PoseColumns kEurocColumns{.quaternion = {5, 6, 7, 4}};

/// The columns of a pose among others.
struct NamedColumns {
  PoseColumns columns;
  std::string other_stamp = {};  ///< the name of another column that counts time, which is not used
};

/// Finds the stamp (timestamp, time, stamp, ts, t, header.stamp), the position (tx, px, x, p_x, p_RS_R_x,
/// pos_x, position.x, ...) and the quaternion (qx, q_x, q_RS_x, quat_x, rot_x, orientation.x, ...). Names
/// that say velocity, rate, acceleration, bias or covariance are none of these. Units are in brackets, or the
/// last word ("time_ns"): of stamps s, ms, us, ns; of positions m, cm, mm, km.
///
/// Of two columns that count time, the stamp of a header goes before timestamp, stamp, time, ts and t, and
/// these before a unit alone (sec). Two columns of one name, of which one is in seconds, are the seconds of
/// the stamp and its fraction (stamp.sec, stamp.nanosec). Error data_corrupt: a column is missing, or two
/// columns have the name of one value.
[[nodiscard]] Result<NamedColumns> columns_by_name(std::span<const std::string> names);

}  // namespace fusebench::trajectory
