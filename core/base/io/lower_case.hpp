// Text without the case of its letters.
#pragma once

#include <string>
#include <string_view>

namespace fusebench::io {

/// The text with the letters of ASCII in lower case, whatever the locale; other bytes stay.
[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

}  // namespace fusebench::io
