// A test that decides about a frame: a quantity, and the limit that it has to keep.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fusebench::acceptance {

enum class Bound { at_least, at_most };

struct AcceptanceTest {
  std::string_view quantity;    ///< its name, with the unit
  std::optional<double> value;  ///< nothing: the frame has none, and passes
  Bound bound = Bound::at_least;
  double limit = 0;
  std::string_view option;  ///< that sets the limit; empty: the limit is fixed
};

/// What the first test that fails says: quantity, value, limit and option; empty if all pass.
[[nodiscard]] std::string first_failure(std::span<const AcceptanceTest> tests);

}  // namespace fusebench::acceptance
