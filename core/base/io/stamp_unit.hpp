// In which unit the stamps of a file can be.
#pragma once

#include <string_view>

#include "core/base/io/text_table.hpp"

namespace fusebench::io {

/// The unit that a stamp since 1970 can only be in: 1e11 s are in the year 5138, 1e11 ms in 1973. Seconds if
/// the stamp is below 1e11, or not a number.
[[nodiscard]] TimeUnit unit_by_size(std::string_view stamp);

/// Decimals of a stamp without the zeros at the end: 2 of "12.340", 0 of "1.4e9" and of what is no number.
[[nodiscard]] int stamp_decimals(std::string_view stamp);

/// Within the range of parse_time_ns(), and without digits beyond the nanosecond: "12.5" are no nanoseconds.
/// Digits beyond the nanosecond of a stamp in seconds are rounding.
[[nodiscard]] bool can_be_in(TimeUnit unit, std::string_view stamp);

}  // namespace fusebench::io
