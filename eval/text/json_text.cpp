#include "eval/text/json_text.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "eval/text/control_characters.hpp"

namespace fusebench::text {

std::string json_text(const nlohmann::ordered_json& document, int indent) {
  const std::string text =
      document.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (std::string_view left = text; !left.empty();) {
    const bool plain = (left[0] >= ' ' && left[0] <= '~') || left[0] == '\n';
    const FirstCharacter first = plain ? FirstCharacter{} : first_character(left);
    if (first.control) {
      safe += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(first.code));
    } else {
      safe += left.substr(0, first.bytes);
    }
    left.remove_prefix(first.bytes);
  }
  return safe;
}

}  // namespace fusebench::text
