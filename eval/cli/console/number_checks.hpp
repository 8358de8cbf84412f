// Checks of number ranges, also without an upper end, with short messages.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

namespace fusebench::cli::console {

namespace detail {

template <class Allows>
[[nodiscard]] CLI::Validator number_check(const char* range, const char* description, Allows allows) {
  return {[range, allows](const std::string& text) {
            double value = 0;
            const char* const begin = text.data() + (text.starts_with('+') ? 1 : 0);  // "+0.1"
            const auto [end, status] = std::from_chars(begin, text.data() + text.size(), value);
            const bool number = status == std::errc{} && end == text.data() + text.size();
            return number && allows(value) ? std::string() : text + " (allowed: " + range + ")";
          },
          description};
}

}  // namespace detail

[[nodiscard]] inline CLI::Validator not_negative() {
  return detail::number_check("0 or more", "NONNEGATIVE", [](double value) { return value >= 0; });
}

[[nodiscard]] inline CLI::Validator positive() {
  return detail::number_check("above 0", "POSITIVE", [](double value) { return value > 0; });
}

/// Both ends are allowed. CLI11's own check accepts "nan".
[[nodiscard]] inline CLI::Validator number_range(double least, double most) {
  const CLI::Range range(least, most);
  CLI::Validator strict = range;
  strict.operation([range](std::string& text) {
    double value = 0;
    const bool nan = CLI::detail::lexical_cast(text, value) && std::isnan(value);
    return nan ? text + " (allowed: a number)" : range(text);
  });
  return strict;
}

/// Stamps and their differences in seconds, so that a sum of two fits 64-bit nanoseconds.
[[nodiscard]] inline CLI::Validator stamp_range() {
  constexpr double kMost_s = 4e9;
  return detail::number_check("-4e9 to 4e9", "-4e9 TO 4e9",
                              [](double value) { return std::abs(value) <= kMost_s; });
}

}  // namespace fusebench::cli::console
