// How documents are written as JSON text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fusebench::text {

/// indent: spaces a level, -1 for one line. Bytes that are no UTF-8 (a folder's name may hold any) become
/// U+FFFD, since the library would throw otherwise. Control characters (control_characters.hpp) are written
/// as
/// \\uNNNN, so that a terminal does not obey them; a reader gets the same text.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& document, int indent = 2);

}  // namespace fusebench::text
