#include "eval/suites/run_selection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/config/config_access.hpp"
#include "core/config/variants.hpp"

namespace fusebench::suites {

namespace {

constexpr std::array<std::string_view, 3> kLimitKeys = {"time_s", "stall_s", "memory_mb"};

bool matches(std::string_view pattern, std::string_view name) {
  if (pattern.empty()) return true;
  if (!pattern.ends_with('*')) return pattern == name;
  return name.starts_with(pattern.substr(0, pattern.size() - 1));
}

Result<Exclusion> read_exclusion(const EntryTable& table) {
  Exclusion exclusion;
  exclusion.place = table.place;
  config::EffectiveConfig scratch;  // whether the options exist and take the values
  for (const config::TomlEntry& entry : table.entries) {
    std::string* const text = entry.key == "reason"      ? &exclusion.reason
                              : entry.key == "recording" ? &exclusion.recording
                              : entry.key == "variant"   ? &exclusion.variant
                                                         : nullptr;
    if (text != nullptr) {
      auto read = text_entry(entry);
      if (!read) return tl::unexpected(read.error());
      *text = std::move(*read);
      if (entry.key == "variant") exclusion.variant_place = entry.place;
      continue;
    }
    const auto* value = std::get_if<config::OptionValue>(&entry.value);
    if (value == nullptr) return wrong_entry(entry, "one value");
    if (auto set = scratch.set(entry.key, *value, entry.place); !set) return tl::unexpected(set.error());
    exclusion.options.emplace_back(entry.key, *value);
  }
  if (exclusion.reason.empty()) {
    return fail(ErrorCode::configuration, fmt::format("{}: the key 'reason' is missing", table.place),
                "an exclusion says why, for whoever reads the results");
  }
  return exclusion;
}

}  // namespace

bool Exclusion::covers(std::string_view recording_name, std::string_view variant_name,
                       const std::vector<config::OptionRow>& options_of_run) const {
  if (!matches(recording, recording_name) || (!variant.empty() && variant != variant_name)) return false;
  return std::ranges::all_of(options, [&](const auto& wanted) {
    config::EffectiveConfig scratch;
    if (!scratch.set(wanted.first, wanted.second, "")) return false;
    const auto value_in = [&](const std::vector<config::OptionRow>& rows) {
      return std::ranges::find(rows, wanted.first, &config::OptionRow::key)->value;
    };
    return value_in(config::describe_options(scratch.values())) == value_in(options_of_run);
  });
}

Result<std::vector<Exclusion>> read_exclusions(const std::vector<EntryTable>& tables) {
  std::vector<Exclusion> exclusions;
  for (const EntryTable& table : tables) {
    auto exclusion = read_exclusion(table);
    if (!exclusion) return tl::unexpected(exclusion.error());
    exclusions.push_back(std::move(*exclusion));
  }
  return exclusions;
}

Result<void> check_excluded_variants(const std::vector<Exclusion>& exclusions,
                                     const std::vector<std::string>& programs) {
  for (const Exclusion& exclusion : exclusions) {
    if (exclusion.variant.empty() || std::ranges::find(programs, exclusion.variant) != programs.end())
      continue;
    if (const auto known = config::find_variant(exclusion.variant); !known)
      return fail(ErrorCode::configuration,
                  fmt::format("{}: {}", exclusion.variant_place, known.error().message));
  }
  return {};
}

Result<void> read_limit(const config::TomlEntry& entry, std::string_view key, RunLimits& limits) {
  if (std::ranges::find(kLimitKeys, key) == kLimitKeys.end())
    return unknown_key(entry.place, std::string(key), kLimitKeys, "[limits]");
  const auto number = number_entry(entry);
  if (!number) return tl::unexpected(number.error());
  if (!(*number > 0)) return wrong_entry(entry, "a number above 0");
  constexpr double kBytesPerMegabyte = 1e6;
  if (key == "time_s") limits.time_s = *number;
  if (key == "stall_s") limits.stall_s = *number;
  if (key == "memory_mb") limits.memory_bytes = static_cast<std::uint64_t>(*number * kBytesPerMegabyte);
  return {};
}

Result<std::vector<run::FrameWindow>> windows_entry(const config::TomlEntry& entry) {
  const auto texts = names_entry(entry, true);
  if (!texts) return tl::unexpected(texts.error());
  std::vector<run::FrameWindow> windows;
  for (const std::string& text : *texts) {
    const auto window = run::parse_window(text);
    if (!window)
      return fail(ErrorCode::configuration, fmt::format("{}: {}", entry.place, window.error().message));
    windows.push_back(*window);
  }
  return windows;
}

}  // namespace fusebench::suites
