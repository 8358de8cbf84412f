#include "eval/experiment.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

#include "core/nearest_name.hpp"
#include "datasets/open_recording.hpp"
#include "datasets/recording_catalogue.hpp"

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
  if (!text) return wrong(entry, "\"recorded\", \"synthetic\" or \"auto\"");
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

/// The folders in a folder, except hidden ones.
std::vector<fs::path> folders_in(const fs::path& parent, std::error_code& error) {
  std::vector<fs::path> folders;
  for (fs::directory_iterator entry(parent, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (entry->is_directory(ignored) && !entry->path().filename().string().starts_with('.')) {
      folders.push_back(entry->path());
    }
  }
  return folders;
}

/// A recording of the catalogue that is not under `data`.
tl::unexpected<Error> not_there(const CatalogueEntry& entry, const fs::path& data) {
  const std::string folder = (data / entry.folders.front()).string();
  return fail(
      ErrorCode::data_missing,
      fmt::format("{} ({}) is a known recording, but there is no folder {}", entry.name, entry.title, folder),
      entry.downloads.empty()
          ? fmt::format("{}; unpack it to {}", entry.download_note, folder)
          : fmt::format("fetch it with scripts/fetch_datasets.sh {} --data {}", entry.name, data.string()));
}

/// The recording under `data` whose folder has that name, or an error that names the nearest.
Result<fs::path> find_folder_named(const std::string& name, const fs::path& data) {
  std::vector<std::string> present;
  if (const auto folders = recordings_under(data)) {
    for (const fs::path& folder : *folders) {
      if (folder.filename() == name) return folder;
      present.push_back(folder.filename().string());
    }
  }
  std::vector<std::string_view> known(present.begin(), present.end());
  for (const CatalogueEntry& entry : recording_catalogue()) known.push_back(entry.name);
  const std::string there = present.empty()
                                ? "there are none under --data"
                                : fmt::format("under --data there are: {}", fmt::join(present, ", "));
  return fail(ErrorCode::data_missing, fmt::format("no recording '{}' here or under {}", name, data.string()),
              fmt::format("did you mean {}? {}", nearest_name(name, known), there));
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
  if (text == "auto") return ImuChoice::automatic;
  return fail(ErrorCode::configuration, fmt::format("imu = {} (allowed: recorded | synthetic | auto)", text));
}

Result<std::vector<fs::path>> recordings_under(const fs::path& data) {
  std::error_code error;
  std::vector<fs::path> folders;
  for (const fs::path& folder : folders_in(data, error)) {
    if (recognise_format(folder)) {
      folders.push_back(folder);
      continue;
    }
    std::error_code ignored;  // a folder that may not be read holds nothing for us
    for (const fs::path& inner : folders_in(folder, ignored)) {
      if (recognise_format(inner)) folders.push_back(inner);
    }
  }
  if (error) {
    return fail(ErrorCode::data_missing,
                fmt::format("{}: cannot be listed: {}", data.string(), error.message()),
                "--data or FUSEBENCH_DATA names the folder of recordings");
  }
  if (folders.empty()) {
    return fail(ErrorCode::data_missing, fmt::format("{}: holds no recordings", data.string()),
                "scripts/fetch_datasets.sh downloads published ones; `fusebench list recordings` names them");
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
  const CatalogueEntry* entry = find_catalogue_entry(name);
  if (data.empty()) {
    return fail(ErrorCode::data_missing,
                entry == nullptr
                    ? fmt::format("{}: no such folder", name)
                    : fmt::format("{} is a known recording, but no folder of recordings is given", name),
                "--data or FUSEBENCH_DATA names the folder of recordings");
  }
  if (fs::is_directory(data / name, ignored)) return data / name;
  if (entry != nullptr) {
    const auto folder = catalogue_folder(*entry, data);
    if (folder) return *folder;
    return not_there(*entry, data);
  }
  return find_folder_named(name, data);
}

}  // namespace fusebench
