// Text that stays text in HTML, XML and Markdown, and bytes within text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace fusebench::text {

/// The text with an entity (&amp;) in place of each of these characters, which are some of & < > " ' @.
[[nodiscard]] std::string with_entities(std::string_view text, std::string_view characters);

[[nodiscard]] std::string base64(std::span<const std::uint8_t> bytes);

}  // namespace fusebench::text
