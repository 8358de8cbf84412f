// "Did you mean": the nearest name by edit distance.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace fusebench {
inline namespace base {

/// The name with the least Levenshtein distance (the first of equals); empty for an empty list.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string_view> names);

}  // namespace base
}  // namespace fusebench
