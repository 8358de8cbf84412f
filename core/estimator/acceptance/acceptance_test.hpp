// An acceptance test of a frame: a quantity and its limit.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fusebench::acceptance {

enum class Bound { at_least, at_most };

struct AcceptanceTest {
  std::string_view quantity;    ///< its name, with the unit
  std::optional<double> value;  ///< no value: the test passes
  Bound bound = Bound::at_least;
  double limit = 0;
  std::string_view option;  ///< option that sets the limit; empty: the limit is fixed
};

/// Describes the first test that fails: quantity, value, limit and option. Empty if all pass.
[[nodiscard]] std::string first_failure(std::span<const AcceptanceTest> tests);

}  // namespace fusebench::acceptance
