// What the readers of TOML files ask of one entry.
#pragma once

#include <fmt/format.h>

#include <string_view>
#include <variant>

#include "core/config/toml_document.hpp"

namespace fusebench::config {

/// Error configuration: "file:line: key must be ...".
[[nodiscard]] inline tl::unexpected<Error> wrong_value(const TomlEntry& entry, std::string_view expected) {
  return fail(ErrorCode::configuration, fmt::format("{}: {} must be {}", entry.place, entry.key, expected));
}

/// The entry's value if it is one of this type and no list; else null.
template <class T>
[[nodiscard]] const T* plain_value(const TomlEntry& entry) {
  const auto* value = std::get_if<OptionValue>(&entry.value);
  return value == nullptr ? nullptr : std::get_if<T>(value);
}

}  // namespace fusebench::config
