#include "eval/suites/only_filters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

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

}  // namespace

bool variant_may_be_wanted(const OnlyFilters& only, std::string_view variant) {
  return suits_one(only, "variant=", [&](std::string_view value) { return variant == value; });
}

bool recording_may_be_wanted(const OnlyFilters& only, std::string_view name) {
  if (name.ends_with('*')) name.remove_suffix(1);
  return suits_one(
      only, "recording=", [&](std::string_view value) { return name.find(value) != std::string_view::npos; });
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
  std::ranges::sort(variants);
  const auto repeated = std::ranges::unique(variants);
  variants.erase(repeated.begin(), repeated.end());
  constexpr std::string_view kKey = "variant=";
  for (const std::string& filter : only) {
    if (!filter.starts_with(kKey)) continue;
    const std::string name = filter.substr(kKey.size());
    if (std::ranges::binary_search(variants, name)) continue;
    return fail(ErrorCode::usage,
                fmt::format("--only {}: suite '{}' has no such variant{}", filter, suite,
                            nearest_hint(name, variants)),
                fmt::format("it has {}", fmt::join(variants, ", ")));
  }
  return {};
}

}  // namespace fusebench::suites
