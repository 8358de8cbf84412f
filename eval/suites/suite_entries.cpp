#include "eval/suites/suite_entries.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/base/nearest_name.hpp"
#include "core/config/variants.hpp"

namespace fusebench::suites {

tl::unexpected<Error> wrong_entry(const config::TomlEntry& entry, std::string_view expected) {
  return fail(ErrorCode::configuration, fmt::format("{}: {} must be {}", entry.place, entry.key, expected));
}

tl::unexpected<Error> unknown_key(const std::string& place, const std::string& key,
                                  std::span<const std::string_view> keys, std::string_view what) {
  return fail(ErrorCode::configuration,
              fmt::format("{}: unknown key '{}'{}", place, key, nearest_hint(key, keys)),
              fmt::format("keys of {} are {}", what, fmt::join(keys, ", ")));
}

Result<std::string> text_entry(const config::TomlEntry& entry) {
  auto text = plain_entry<std::string>(entry);
  if (!text || text->empty()) return wrong_entry(entry, "a text that is not empty");
  return std::move(*text);
}

Result<void> check_folder_name(const config::TomlEntry& entry, std::string_view name) {
  const auto plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
           c == '-' || c == '.';
  };
  constexpr std::size_t kLongest = 200;  // file systems take 255, and hidden names are a little longer
  if (std::all_of(name.begin(), name.end(), plain) && !name.starts_with('.') && name.size() <= kLongest)
    return {};
  return fail(
      ErrorCode::configuration,
      fmt::format("{}: {} = '{}' is no name of letters, digits, _, - and . (at most {}, the first no .)",
                  entry.place, entry.key, name, kLongest),
      "it becomes the name of a folder");
}

Result<std::string> folder_name_entry(const config::TomlEntry& entry) {
  auto name = text_entry(entry);
  if (!name) return name;
  if (auto good = check_folder_name(entry, *name); !good) return tl::unexpected(good.error());
  return name;
}

Result<bool> flag_entry(const config::TomlEntry& entry) {
  const auto flag = plain_entry<bool>(entry);
  if (!flag) return wrong_entry(entry, "true or false");
  return *flag;
}

Result<double> number_entry(const config::TomlEntry& entry) {
  if (const auto integer = plain_entry<std::int64_t>(entry)) return static_cast<double>(*integer);
  const auto number = plain_entry<double>(entry);
  if (!number || !std::isfinite(*number)) return wrong_entry(entry, "a number");
  return *number;
}

Result<std::uint64_t> count_entry(const config::TomlEntry& entry) {
  const auto integer = plain_entry<std::int64_t>(entry);
  if (!integer || *integer < 0) return wrong_entry(entry, "an integer, 0 or more");
  return static_cast<std::uint64_t>(*integer);
}

Result<std::vector<std::string>> names_entry(const config::TomlEntry& entry, bool one_allowed) {
  if (one_allowed && plain_entry<std::string>(entry)) {
    auto text = text_entry(entry);
    if (!text) return tl::unexpected(text.error());
    return std::vector<std::string>{std::move(*text)};
  }
  const auto* list = std::get_if<config::TomlList>(&entry.value);
  if (list == nullptr || list->empty()) return wrong_entry(entry, "a list of names that is not empty");
  std::vector<std::string> result;
  for (const config::OptionValue& value : *list) {
    const auto* name = std::get_if<std::string>(&value);
    if (name == nullptr) return wrong_entry(entry, "a list of names");
    if (std::find(result.begin(), result.end(), *name) != result.end()) {
      return fail(ErrorCode::configuration,
                  fmt::format("{}: {} lists \"{}\" twice", entry.place, entry.key, *name));
    }
    result.push_back(*name);
  }
  return result;
}

Result<std::vector<std::string>> variants_entry(const config::TomlEntry& entry) {
  auto list = names_entry(entry);
  if (!list) return list;
  if (auto known = check_variants(entry, *list); !known) return tl::unexpected(known.error());
  return list;
}

Result<void> check_variants(const config::TomlEntry& entry, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (const auto variant = config::find_variant(name); !variant) {
      return fail(ErrorCode::configuration, fmt::format("{}: {}", entry.place, variant.error().message),
                  variant.error().hint);
    }
  }
  return {};
}

const config::TomlEntry* EntryTable::find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [&](const config::TomlEntry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::vector<EntryTable> entry_tables(const config::TomlDocument& document, std::string_view name) {
  std::vector<EntryTable> tables;
  for (std::size_t i = 0;; ++i) {
    const std::string key = fmt::format("{}[{}]", name, i);
    const auto header = std::find_if(document.tables.begin(), document.tables.end(),
                                     [&](const config::TomlTable& table) { return table.key == key; });
    if (header == document.tables.end()) return tables;
    EntryTable table{header->place, {}};
    for (const config::TomlEntry& entry : document.entries) {
      if (!entry.key.starts_with(key + ".")) continue;
      table.entries.push_back({entry.key.substr(key.size() + 1), entry.value, entry.place});
    }
    tables.push_back(std::move(table));
  }
}

std::optional<std::string_view> list_of_key(std::string_view key) {
  const std::size_t bracket = key.find('[');
  if (bracket == std::string_view::npos || key.find('.') < bracket) return std::nullopt;
  return key.substr(0, bracket);
}

}  // namespace fusebench::suites
