#include "core/base/io/stamp_unit.hpp"

#include <algorithm>
#include <charconv>

namespace fusebench::io {

TimeUnit unit_by_size(std::string_view stamp) {
  const Result<double> value = parse_number(stamp);
  constexpr double kMostSeconds = 1e11;
  if (!value || *value < kMostSeconds) return TimeUnit::seconds;
  if (*value < 1e3 * kMostSeconds) return TimeUnit::milliseconds;
  return *value < 1e6 * kMostSeconds ? TimeUnit::microseconds : TimeUnit::nanoseconds;
}

int stamp_decimals(std::string_view stamp) {
  if (!parse_number(stamp)) return 0;
  const std::size_t end = std::min(stamp.find_first_of("eE"), stamp.size());
  int exponent = 0;
  if (end < stamp.size()) {
    const std::size_t sign = stamp.substr(end + 1).starts_with('+') ? 1 : 0;
    std::from_chars(stamp.data() + end + 1 + sign, stamp.data() + stamp.size(), exponent);
  }
  std::string_view digits = stamp.substr(0, end);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t last = digits.find_last_not_of("0.");
  const int written = last == std::string_view::npos || last < point ? 0 : static_cast<int>(last - point);
  constexpr int kMostExponent = 1000;
  return std::max(0, written - std::clamp(exponent, -kMostExponent, kMostExponent));
}

bool can_be_in(TimeUnit unit, std::string_view stamp) {
  if (!parse_time_ns(stamp, unit)) return false;
  return unit == TimeUnit::seconds || stamp_decimals(stamp) <= static_cast<int>(unit);
}

}  // namespace fusebench::io
