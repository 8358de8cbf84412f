// Numbers of an independent implementation, as close as two ways of rounding come.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace fusebench::testing {

inline constexpr double kRelative = 1e-9;
inline constexpr double kAbsolute = 1e-12;

/// `what` names the number in the message.
inline void expect_close(double value, double wanted, const std::string& what, double absolute = kAbsolute) {
  EXPECT_NEAR(value, wanted, std::max(absolute, kRelative * std::abs(wanted))) << what;
}

}  // namespace fusebench::testing
