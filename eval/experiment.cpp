#include "eval/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include "core/nearest_name.hpp"

namespace fusebench {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 6> kSuiteKeys = {"name",     "recordings", "all",
                                                        "variants", "imu",        "config"};
constexpr std::string_view kConfigPrefix = "config.";

tl::unexpected<Error> wrong(const TomlEntry& entry, std::string_view expected) {
  return fail(ErrorCode::configuration, fmt::format("{}: {} must be {}", entry.place, entry.key, expected));
}

template <class T>
std::optional<T> plain(const TomlEntry& entry) {
  const auto* value = std::get_if<OptionValue>(&entry.value);
  const T* typed = value == nullptr ? nullptr : std::get_if<T>(value);
  return typed == nullptr ? std::nullopt : std::optional<T>(*typed);
}

/// A non-empty list of texts, each once.
Result<std::vector<std::string>> names(const TomlEntry& entry) {
  const auto* list = std::get_if<TomlList>(&entry.value);
  if (list == nullptr || list->empty()) return wrong(entry, "a list of names that is not empty");
  std::vector<std::string> result;
  for (const OptionValue& value : *list) {
    const auto* name = std::get_if<std::string>(&value);
    if (name == nullptr) return wrong(entry, "a list of names");
    if (std::find(result.begin(), result.end(), *name) != result.end()) {
      return fail(ErrorCode::configuration,
                  fmt::format("{}: {} lists \"{}\" twice", entry.place, entry.key, *name));
    }
    result.push_back(*name);
  }
  return result;
}

Result<void> read_variants(const TomlEntry& entry, Suite& suite) {
  auto list = names(entry);
  if (!list) return tl::unexpected(list.error());
  for (const std::string& name : *list) {
    if (const auto variant = find_variant(name); !variant) {
      return fail(ErrorCode::configuration, fmt::format("{}: {}", entry.place, variant.error().message),
                  variant.error().hint);
    }
  }
  suite.variants = std::move(*list);
  return {};
}

Result<void> read_imu(const TomlEntry& entry, Suite& suite) {
  const auto text = plain<std::string>(entry);
  if (!text) return wrong(entry, "\"recorded\" or \"synthetic\"");
  const auto choice = parse_imu_choice(*text);
  if (!choice)
    return fail(ErrorCode::configuration, fmt::format("{}: {}", entry.place, choice.error().message));
  suite.imu = *choice;
  return {};
}

tl::unexpected<Error> unknown_key(const std::string& place, const std::string& key) {
  return fail(ErrorCode::configuration,
              fmt::format("{}: unknown key '{}' (nearest: {})", place, key, nearest_name(key, kSuiteKeys)),
              fmt::format("keys of a suite are {}", fmt::join(kSuiteKeys, ", ")));
}

Result<void> read_entry(const TomlEntry& entry, Suite& suite) {
  if (entry.key == "name") {
    const auto name = plain<std::string>(entry);
    if (!name || name->empty()) return wrong(entry, "a text");
    suite.name = *name;
    return {};
  }
  if (entry.key == "all") {
    const auto all = plain<bool>(entry);
    if (!all) return wrong(entry, "true or false");
    suite.all = *all;
    return {};
  }
  if (entry.key == "recordings") {
    auto list = names(entry);
    if (!list) return tl::unexpected(list.error());
    suite.recordings = std::move(*list);
    return {};
  }
  if (entry.key == "variants") return read_variants(entry, suite);
  if (entry.key == "imu") return read_imu(entry, suite);
  if (entry.key.starts_with(kConfigPrefix)) {
    suite.config.push_back({entry.key.substr(kConfigPrefix.size()), entry.value, entry.place});
    return {};
  }
  return unknown_key(entry.place, entry.key);
}

Result<void> check_suite(const Suite& suite, const fs::path& file) {
  const auto lacks = [&](std::string_view what) {
    return fail(ErrorCode::configuration, fmt::format("{}: {}", file.string(), what));
  };
  if (suite.name.empty()) return lacks("the key 'name' is missing");
  if (suite.variants.empty()) return lacks("the key 'variants' is missing");
  if (suite.all == !suite.recordings.empty()) return lacks("either 'recordings' or 'all = true' is needed");
  // Each edit must be one that a configuration takes, before hours are spent on the runs before it.
  for (const std::string& name : suite.variants) {
    const auto config = suite_config(suite, *find_variant(name));
    if (!config) return tl::unexpected(config.error());
    if (auto related = check_relations(config->values); !related) {
      return lacks(fmt::format("variant {}: {}", name, related.error().message));
    }
  }
  return {};
}

}  // namespace

Result<Suite> read_suite(const fs::path& file) {
  const auto document = read_toml(file);
  if (!document) return tl::unexpected(document.error());
  for (const TomlTable& table : document->tables) {
    if (table.key != "config" && !table.key.starts_with(kConfigPrefix))
      return unknown_key(table.place, table.key);
  }
  Suite suite;
  for (const TomlEntry& entry : document->entries) {
    if (auto read = read_entry(entry, suite); !read) return tl::unexpected(read.error());
  }
  if (auto complete = check_suite(suite, file); !complete) return tl::unexpected(complete.error());
  return suite;
}

Result<EffectiveConfig> suite_config(const Suite& suite, const Variant& variant) {
  EffectiveConfig config = variant_config(variant);
  for (const TomlEntry& entry : suite.config) {
    const auto* value = std::get_if<OptionValue>(&entry.value);
    if (value == nullptr) return wrong(entry, "one value, not a list");
    if (auto set = config.set(entry.key, *value, entry.place); !set) return tl::unexpected(set.error());
  }
  return config;
}

Result<ImuChoice> parse_imu_choice(const std::string& text) {
  if (text == "recorded") return ImuChoice::recorded;
  if (text == "synthetic") return ImuChoice::synthetic;
  return fail(ErrorCode::configuration, fmt::format("imu = {} (allowed: recorded | synthetic)", text));
}

Result<std::vector<fs::path>> recordings_under(const fs::path& data) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (fs::directory_iterator entry(data, error), end; !error && entry != end; entry.increment(error)) {
    // The lists that every format known so far has.
    if (fs::exists(entry->path() / "rgb.txt") && fs::exists(entry->path() / "depth.txt")) {
      folders.push_back(entry->path());
    }
  }
  if (error) {
    return fail(ErrorCode::data_missing,
                fmt::format("{}: cannot be listed: {}", data.string(), error.message()),
                "--data or FUSEBENCH_DATA names the folder of recordings");
  }
  if (folders.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: holds no recordings", data.string()),
                "a recording is a folder with rgb.txt and depth.txt");
  }
  std::sort(folders.begin(), folders.end());
  return folders;
}

Result<fs::path> find_recording(const std::string& name, const fs::path& data) {
  std::error_code ignored;
  if (fs::is_directory(name, ignored)) {
    // "folder/" and "." have no last name.
    const fs::path folder = fs::weakly_canonical(name, ignored);
    return ignored ? fs::path(name) : folder;
  }
  if (data.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: no such folder", name),
                "with --data or FUSEBENCH_DATA, recordings can be named by their folder's name");
  }
  if (fs::is_directory(data / name, ignored)) return data / name;
  std::vector<std::string> known;
  if (const auto folders = recordings_under(data)) {
    for (const fs::path& folder : *folders) known.push_back(folder.filename().string());
  }
  const std::vector<std::string_view> views(known.begin(), known.end());
  return fail(ErrorCode::data_missing, fmt::format("no recording '{}' here or under {}", name, data.string()),
              known.empty() ? "there are no recordings under --data"
                            : fmt::format("did you mean {}? There are: {}", nearest_name(name, views),
                                          fmt::join(known, ", ")));
}

}  // namespace fusebench
