// "Did you mean": the nearest name by its beginning, then by edit distance.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench {
inline namespace base {

/// Of the names that are alike the one with the least edit distance (the first of equals), those that
/// begin with `name` before others if that has at least 2 letters behind its dashes; empty where none is
/// alike (dashes in front make nothing alike). Two are alike if one is such a beginning of the other, if at
/// most half of the longer one differs, or less than a third of the shorter one from a part of the longer
/// one.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string_view> names);

/// " (nearest: NAME)", to go on behind "unknown ... 'name'"; empty where no name is alike.
[[nodiscard]] std::string nearest_hint(std::string_view name, std::span<const std::string_view> names);
[[nodiscard]] std::string nearest_hint(std::string_view name, const std::vector<std::string>& names);

/// "did you mean NAME?"; empty where no name is alike.
[[nodiscard]] std::string did_you_mean(std::string_view name, std::span<const std::string_view> names);

}  // namespace base
}  // namespace fusebench
