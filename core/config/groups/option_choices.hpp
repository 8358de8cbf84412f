// The names of an enumeration's values, for options that choose among them.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace fusebench::config {

/// Names of an enumeration's values, in the order in which they are documented.
template <class Enum, std::size_t N>
constexpr std::array<std::pair<std::string_view, Enum>, N> choices(
    const std::pair<std::string_view, Enum> (&list)[N]) {
  return std::to_array(list);
}

}  // namespace fusebench::config
