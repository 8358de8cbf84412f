// A TOML file as a flat list of dotted keys with their lines, and typed access to an entry. The only unit
// that uses the parser.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/options.hpp"

namespace fusebench::config {

/// A list of plain values, e.g. variants = ["full", "dm"].
using TomlList = std::vector<OptionValue>;

/// One assignment of the file.
struct TomlEntry {
  /// dotted: [iekf] max_iterations = 8 has the key "iekf.max_iterations", the first [[criteria]] title = "x"
  /// the key "criteria[0].title"
  std::string key;
  std::variant<OptionValue, TomlList> value;
  std::string place;  ///< "file:line", for messages
};

/// One [table] or [[table]] header (or inline table), also when it is empty.
struct TomlTable {
  std::string key;
  std::string place;
};

struct TomlDocument {
  std::vector<TomlEntry> entries;  ///< in the order of the file
  std::vector<TomlTable> tables;   ///< in the order of the file
};

/// Reads a TOML file. Errors: data_missing if it cannot be opened; configuration, with file:line, for bad
/// syntax, for unsupported values (dates, lists of tables and other values, quoted keys that are not plain
/// names), and for more than 1 MiB.
[[nodiscard]] Result<TomlDocument> read_toml(const std::filesystem::path& file);

/// Parses a text like read_toml(); `name` is the file name in messages.
[[nodiscard]] Result<TomlDocument> parse_toml(std::string_view text, const std::string& name);

/// A value as TOML text: true, 8, 0.5, "text"; doubles with the shortest text that reads back the
/// same.
[[nodiscard]] std::string to_toml(const OptionValue& value);

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
