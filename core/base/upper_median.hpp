// The median of a list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace fusebench {
inline namespace base {

/// The median of the values; the larger of the two middle values if their number is even. Values must not be
/// empty.
template <class Value>
[[nodiscard]] Value upper_median(std::vector<Value> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace base
}  // namespace fusebench
