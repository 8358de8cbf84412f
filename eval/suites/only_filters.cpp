#include "eval/suites/only_filters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::suites {

namespace {

/// Whether a value suits what --only says of a key: any of its values, or nothing.
template <class Suits>
bool suits_one(const OnlyFilters& only, std::string_view key, const Suits& suits) {
  bool asked = false;
  for (const std::string_view filter : only) {
    if (!filter.starts_with(key)) continue;
    asked = true;
    if (suits(filter.substr(key.size()))) return true;
  }
  return !asked;
}

/// Whether the name of a recording, or the known beginning of it ("begin*"), contains the text.
bool name_contains(std::string_view name, std::string_view text) {
  if (name.ends_with('*')) name.remove_suffix(1);
  return name.find(text) != std::string_view::npos;
}

/// names: of the things that filters of this key choose among. `matches`: whether a name suits a value.
template <class Matches>
Result<void> check_names(const OnlyFilters& only, std::string_view key, const std::string& suite,
                         std::vector<std::string> names, const Matches& matches) {
  std::ranges::sort(names);
  const auto repeated = std::ranges::unique(names);
  names.erase(repeated.begin(), repeated.end());
  for (const std::string& filter : only) {
    if (!filter.starts_with(key) || filter.size() == key.size() || filter[key.size()] != '=') continue;
    const std::string value = filter.substr(key.size() + 1);
    if (std::ranges::any_of(names, [&](const std::string& name) { return matches(name, value); })) continue;
    return fail(
        ErrorCode::usage,
        fmt::format("--only {}: suite '{}' has no such {}{}", filter, suite, key, nearest_hint(value, names)),
        names.empty() ? "it has none" : fmt::format("it has {}", fmt::join(names, ", ")));
  }
  return {};
}

}  // namespace

bool variant_may_be_wanted(const OnlyFilters& only, std::string_view variant) {
  return suits_one(only, "variant=", [&](std::string_view value) { return variant == value; });
}

bool recording_may_be_wanted(const OnlyFilters& only, std::string_view name) {
  return suits_one(only, "recording=", [&](std::string_view value) { return name_contains(name, value); });
}

Result<void> check_filters(const OnlyFilters& only) {
  for (const std::string& filter : only) {
    const auto equals = filter.find('=');
    const std::string key = filter.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : filter.substr(equals + 1);
    constexpr std::array<std::string_view, 3> kKeys = {"recording", "variant", "split"};
    const bool is_key = std::ranges::find(kKeys, key) != kKeys.end();
    if (!is_key || value.empty() || (key == "split" && !is_split(value))) {
      return fail(ErrorCode::usage, fmt::format("--only {}{} (allowed: recording=TEXT | variant=NAME | "
                                                "split=tuning | split=held-out)",
                                                filter, is_key ? "" : nearest_hint(key, kKeys)));
    }
  }
  return {};
}

bool wanted(const OnlyFilters& only, const std::string& recording, const std::string& split,
            const std::string& variant) {
  return suits_one(only, "recording=",
                   [&](std::string_view value) { return recording.find(value) != std::string::npos; }) &&
         suits_one(only, "split=", [&](std::string_view value) { return split == value; }) &&
         variant_may_be_wanted(only, variant);
}

Result<void> check_variants(const OnlyFilters& only, const std::string& suite,
                            std::vector<std::string> variants) {
  return check_names(only, "variant", suite, std::move(variants), std::equal_to<>());
}

Result<void> check_recordings(const OnlyFilters& only, const std::string& suite,
                              std::vector<std::string> recordings) {
  return check_names(only, "recording", suite, std::move(recordings), name_contains);
}

}  // namespace fusebench::suites
