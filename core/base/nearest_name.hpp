// Suggests the nearest name: by prefix first, then by edit distance.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fusebench {
inline namespace base {

/// Returns the most similar name; empty if none is similar. Leading dashes are ignored for similarity. Two
/// names are similar if
/// - one is a prefix of the other,
/// - they differ by at most half of the longer one, or
/// - the shorter one differs by less than a third from a substring of the longer one.
/// Names that begin with `name` (at least 2 letters after the dashes) are preferred, then the least edit
/// distance, then the first.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string_view> names);

/// " (nearest: NAME)", to be appended to "unknown ... 'name'"; empty if no name is similar.
[[nodiscard]] std::string nearest_hint(std::string_view name, std::span<const std::string_view> names);
[[nodiscard]] std::string nearest_hint(std::string_view name, const std::vector<std::string>& names);

/// "did you mean NAME?"; empty if no name is similar.
[[nodiscard]] std::string did_you_mean(std::string_view name, std::span<const std::string_view> names);

}  // namespace base
}  // namespace fusebench
