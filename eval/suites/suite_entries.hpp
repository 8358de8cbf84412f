// Typed reading of the entries of a suite's file. Every refusal is an error configuration with file:line.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/error.hpp"
#include "core/config/toml_document.hpp"

namespace fusebench::suites {

/// "<place>: <key> must be <expected>".
[[nodiscard]] tl::unexpected<Error> wrong_entry(const config::TomlEntry& entry, std::string_view expected);

/// "unknown key", with the nearest of those that `what` (e.g. "a suite") has.
[[nodiscard]] tl::unexpected<Error> unknown_key(const std::string& place, const std::string& key,
                                                std::span<const std::string_view> keys,
                                                std::string_view what);

/// The entry's value if it is of that type and no list.
template <class T>
[[nodiscard]] std::optional<T> plain_entry(const config::TomlEntry& entry) {
  const auto* value = std::get_if<config::OptionValue>(&entry.value);
  const T* typed = value == nullptr ? nullptr : std::get_if<T>(value);
  return typed == nullptr ? std::nullopt : std::optional<T>(*typed);
}

[[nodiscard]] Result<std::string> text_entry(const config::TomlEntry& entry);  ///< not empty
/// A name that becomes a folder, and that --only and tables go by: letters, digits, _, - and .
[[nodiscard]] Result<void> check_folder_name(const config::TomlEntry& entry, std::string_view name);
[[nodiscard]] Result<std::string> folder_name_entry(const config::TomlEntry& entry);
[[nodiscard]] Result<bool> flag_entry(const config::TomlEntry& entry);
[[nodiscard]] Result<double> number_entry(const config::TomlEntry& entry);  ///< also from an integer; finite
[[nodiscard]] Result<std::uint64_t> count_entry(
    const config::TomlEntry& entry);  ///< an integer that is not negative
/// A list that is not empty, each text once; `one_allowed`: or a single text.
[[nodiscard]] Result<std::vector<std::string>> names_entry(const config::TomlEntry& entry,
                                                           bool one_allowed = false);
/// The same of variants.
[[nodiscard]] Result<std::vector<std::string>> variants_entry(const config::TomlEntry& entry);

/// Error configuration at the entry for a name that is no variant.
[[nodiscard]] Result<void> check_variants(const config::TomlEntry& entry,
                                          const std::vector<std::string>& names);
/// Stores the value, or returns its error.
template <class T, class Target>
[[nodiscard]] Result<void> store(Result<T> value, Target& target) {
  if (!value) return tl::unexpected(value.error());
  target = Target(std::move(*value));
  return {};
}

/// One [[table]] of a list of them.
struct EntryTable {
  std::string place;
  std::vector<config::TomlEntry> entries;  ///< with the keys that they have in the table

  [[nodiscard]] const config::TomlEntry* find(std::string_view key) const;
};

/// The tables [[name]] of a document, in order.
[[nodiscard]] std::vector<EntryTable> entry_tables(const config::TomlDocument& document,
                                                   std::string_view name);

/// Of "criteria[3].title" the name "criteria"; nothing for a key that is in no list of tables.
[[nodiscard]] std::optional<std::string_view> list_of_key(std::string_view key);

}  // namespace fusebench::suites
