// Printable form of untrusted text for messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fusebench {
inline namespace base {

/// Text in printable ASCII on one line: every other byte as \xNN, cut after about `most` characters and
/// marked by "...".
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = 40);

}  // namespace base
}  // namespace fusebench
