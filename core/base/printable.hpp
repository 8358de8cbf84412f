// How text from an unknown file is shown in messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fusebench {
inline namespace base {

/// The text in printable ASCII: every other byte as \xNN; after about `most` characters "..." ends it.
/// A message stays one line of valid UTF-8 this way, whatever the file holds.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = 40);

}  // namespace base
}  // namespace fusebench
