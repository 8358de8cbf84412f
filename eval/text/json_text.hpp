// How documents are written as JSON text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace fusebench::text {

/// indent: spaces a level, -1 for one line. Bytes that are no UTF-8 (a folder's name may hold any) become
/// U+FFFD, since the library would throw otherwise.
[[nodiscard]] inline std::string json_text(const nlohmann::ordered_json& document, int indent = 2) {
  return document.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace fusebench::text
