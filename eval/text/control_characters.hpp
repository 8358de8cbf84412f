// Characters that steer a terminal or reorder text, in names and messages of unknown origin.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fusebench::text {

/// The first character of a text in UTF-8.
struct FirstCharacter {
  std::size_t bytes = 1;
  bool valid = true;     ///< false: a byte that is no UTF-8
  bool control = false;  ///< U+0000-001F, U+007F-009F, line separators (U+2028-2029), marks of direction
                         ///< (U+061C, U+200E-200F, U+202A-202E, U+2066-2069)
  char32_t code = 0;
};
[[nodiscard]] FirstCharacter first_character(std::string_view text);  ///< text: not empty

/// The text with \\xNN in place of every byte of a control character or that is no UTF-8. Other characters
/// stay, and so do those of ASCII in `kept`.
[[nodiscard]] std::string without_controls(std::string_view text, std::string_view kept = "");

}  // namespace fusebench::text
