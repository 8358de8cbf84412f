// Options declared once. A configuration struct lists its fields in one visit(self, visitor); everything else
// (reading, writing, range checks, documentation, hashing) is a visitor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

namespace fusebench::config {

/// A value from a file or the command line, before it is assigned to an option.
using OptionValue = std::variant<bool, std::int64_t, double, std::string>;

/// One option with its current value, ready to print.
struct OptionRow {
  std::string key;       ///< dotted, e.g. "iekf.max_iterations"
  std::string type;      ///< "integer", "number", "flag" or "choice"
  std::string value;     ///< as a TOML value, shortest round trip
  std::string range;     ///< e.g. "1 .. 200", "true | false", "imu | constant_velocity"
  std::string sentence;  ///< its effect, with the source
};

namespace detail {

/// Converts to any type: counts the fields of an aggregate by initialisers of increasing length.
struct AnyField {
  template <class T>
  constexpr operator T() const;  // never defined: only its type is used
};

template <class T, class... Fields>
consteval std::size_t field_count() {
  if constexpr (requires { T{Fields{}..., AnyField{}}; }) {
    return field_count<T, Fields..., AnyField>();
  } else {
    return sizeof...(Fields);
  }
}

struct CountingVisitor {
  std::size_t count = 0;
  constexpr void number(std::string_view, const auto&, auto, auto, std::string_view) { ++count; }
  constexpr void flag(std::string_view, const bool&, std::string_view) { ++count; }
  constexpr void choice(std::string_view, const auto&, std::string_view) { ++count; }
  constexpr void group(std::string_view, const auto&) { ++count; }
};

template <class T>
consteval bool options_cover_fields() {
  CountingVisitor visitor;
  const T defaults{};
  T::visit(defaults, visitor);
  return visitor.count == field_count<T>();
}

}  // namespace detail

/// True if each visit() lists as many options as its struct has fields.
template <class... Structs>
consteval bool options_cover_all_fields() {
  return (detail::options_cover_fields<Structs>() && ...);
}

}  // namespace fusebench::config
