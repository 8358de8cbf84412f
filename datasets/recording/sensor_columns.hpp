// Columns of tables that hold what a sensor measured, or where it was: read with the range that is possible.
#pragma once

#include <cstddef>
#include <string_view>

#include "core/base/error.hpp"
#include "core/base/io/text_table.hpp"
#include "core/base/types.hpp"

namespace fusebench::recording {

// Beyond these, a number is an error of the file. They are far from what is measured and near enough that
// squares, sums and conversions to nanoseconds of all that follows stay within their types.
inline constexpr double kMaxAngularVelocity_radps = 200;  ///< MEMS gyroscopes end at 4000 deg/s: 70 rad/s
inline constexpr double kMaxSpecificForce_mps2 = 2000;    ///< 200 g; those of IMUs end at 16 to 32 g
inline constexpr double kMaxPosition_m = 1e7;             ///< northings of UTM reach that
inline constexpr double kMaxVelocity_mps = 1000;

/// Three neighbouring columns of the current row, each within the limit above. name: that of all three, to
/// which x, y and z are added. Error data_corrupt, with file:line, the column and what is allowed: no number,
/// or one out of its range.
[[nodiscard]] Result<Vector3d> read_angular_velocity(const io::TextTable& table, std::size_t first_column,
                                                     std::string_view name);
[[nodiscard]] Result<Vector3d> read_specific_force(const io::TextTable& table, std::size_t first_column,
                                                   std::string_view name);
[[nodiscard]] Result<Vector3d> read_position(const io::TextTable& table, std::size_t first_column,
                                             std::string_view name);
[[nodiscard]] Result<Vector3d> read_velocity(const io::TextTable& table, std::size_t first_column,
                                             std::string_view name);

}  // namespace fusebench::recording
