#include "core/base/printable.hpp"

#include <fmt/format.h>

namespace fusebench {
inline namespace base {

std::string printable(std::string_view text, std::size_t most) {
  std::string shown;
  for (const char c : text) {
    if (shown.size() >= most) return shown + "...";
    if (c >= ' ' && c <= '~') {
      shown += c;
    } else {
      shown += fmt::format("\\x{:02X}", static_cast<unsigned char>(c));
    }
  }
  return shown;
}

}  // namespace base
}  // namespace fusebench
