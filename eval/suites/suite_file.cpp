#include "eval/suites/suite_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "eval/run/run_specification.hpp"
#include "eval/suites/suite_entries.hpp"

namespace fusebench::suites {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 17> kSuiteKeys = {
    "name",    "recordings", "all",         "variants",    "systems",   "imu",
    "prepare", "config",     "simulations", "criteria",    "frames",    "keep",
    "limits",  "sweep",      "exclude",     "repetitions", "replicates"};
constexpr std::array<std::string_view, 5> kRecordingKeys = {"name", "group", "split", "variants", "source"};
constexpr std::string_view kConfigPrefix = "config.";
constexpr std::string_view kLimitPrefix = "limits.";

tl::unexpected<Error> unknown_suite_key(const std::string& place, const std::string& key) {
  constexpr std::array<std::string_view, 4> lists = {"sweep", "exclude", "simulations", "criteria"};
  if (std::find(lists.begin(), lists.end(), key) != lists.end())
    return fail(ErrorCode::configuration,
                fmt::format("{}: {} is a list of tables: write [[{}]]", place, key, key));
  return unknown_key(place, key, kSuiteKeys, "a suite");
}

Result<void> read_imu(const config::TomlEntry& entry, Suite& suite) {
  const auto text = plain_entry<std::string>(entry);
  if (!text) return wrong_entry(entry, "\"recorded\", \"synthetic\" or \"auto\"");
  const auto choice = parse_imu_choice(*text);
  if (!choice)
    return fail(ErrorCode::configuration, fmt::format("{}: {}", entry.place, choice.error().message));
  suite.imu = *choice;
  return {};
}

Result<void> read_prepare(const config::TomlEntry& entry, Suite& suite) {
  const auto text = plain_entry<std::string>(entry);
  if (text != "auto" && text != "off") return wrong_entry(entry, "\"auto\" or \"off\"");
  suite.prepare = text == "auto";
  return {};
}

Result<void> read_kept(const config::TomlEntry& entry, Suite& suite) {
  for (const run::KeptFiles kept : {run::KeptFiles::all, run::KeptFiles::small}) {
    if (plain_entry<std::string>(entry) != run::to_string(kept)) continue;
    suite.kept = kept;
    return {};
  }
  return wrong_entry(entry, "\"all\" or \"small\"");
}

/// How often each run is made.
Result<void> read_count(const config::TomlEntry& entry, int most, int& target) {
  const auto count = plain_entry<std::int64_t>(entry);
  if (!count || *count < 1 || *count > most)
    return wrong_entry(entry, fmt::format("an integer, 1 .. {}", most));
  target = static_cast<int>(*count);
  return {};
}

Result<void> read_entry(const config::TomlEntry& entry, Suite& suite) {
  if (entry.key == "name") return store(folder_name_entry(entry), suite.name);
  if (entry.key == "all") return store(flag_entry(entry), suite.all);
  if (entry.key == "variants") return store(variants_entry(entry), suite.variants);
  if (entry.key == "systems") return store(names_entry(entry), suite.systems);
  if (entry.key == "imu") return read_imu(entry, suite);
  if (entry.key == "prepare") return read_prepare(entry, suite);
  if (entry.key == "keep") return read_kept(entry, suite);
  if (entry.key == "repetitions") return read_count(entry, run::kMostRepetitions, suite.repetitions);
  if (entry.key == "replicates") return read_count(entry, run::kMostReplicates, suite.replicates);
  if (entry.key == "frames") return store(windows_entry(entry), suite.windows);
  if (entry.key.starts_with(kLimitPrefix))
    return read_limit(entry, std::string_view(entry.key).substr(kLimitPrefix.size()), suite.limits);
  if (entry.key == "recordings") {
    const auto list = names_entry(entry);
    if (!list) return tl::unexpected(list.error());
    for (const std::string& name : *list) suite.recordings.push_back({.name = name});
    return {};
  }
  if (entry.key.starts_with(kConfigPrefix)) {
    suite.config.push_back({entry.key.substr(kConfigPrefix.size()), entry.value, entry.place});
    return {};
  }
  if (list_of_key(entry.key)) return {};  // read table by table
  return unknown_suite_key(entry.place, entry.key);
}

Result<void> read_recording(const EntryTable& table, Suite& suite) {
  SuiteRecording recording;
  for (const config::TomlEntry& entry : table.entries) {
    if (entry.key == "variants") {
      if (auto read = store(variants_entry(entry), recording.variants); !read) return read;
      continue;
    }
    const std::array<std::pair<std::string_view, std::string*>, 4> texts = {{{"name", &recording.name},
                                                                             {"group", &recording.group},
                                                                             {"split", &recording.split},
                                                                             {"source", &recording.source}}};
    const auto* const target =
        std::find_if(texts.begin(), texts.end(), [&](const auto& text) { return text.first == entry.key; });
    if (target == texts.end()) return unknown_key(entry.place, entry.key, kRecordingKeys, "a recording");
    if (auto read = store(text_entry(entry), *target->second); !read) return read;
    if (!is_split(recording.split)) return wrong_entry(entry, "\"tuning\" or \"held-out\"");
  }
  if (recording.name.empty())
    return fail(ErrorCode::configuration, fmt::format("{}: the key 'name' is missing", table.place));
  suite.recordings.push_back(std::move(recording));
  return {};
}

Result<void> read_tables(const config::TomlDocument& document, Suite& suite) {
  for (const EntryTable& table : entry_tables(document, "recordings")) {
    if (auto read = read_recording(table, suite); !read) return read;
  }
  if (auto read =
          store(read_simulations(entry_tables(document, "simulations"), suite.variants), suite.simulations);
      !read)
    return read;
  if (auto read = store(read_sweeps(entry_tables(document, "sweep")), suite.sweeps); !read) return read;
  if (auto read = store(read_exclusions(entry_tables(document, "exclude")), suite.exclusions); !read)
    return read;
  const std::string reference = suite.variants.empty() ? "" : suite.variants.front();
  return store(read_criteria(entry_tables(document, "criteria"), reference), suite.criteria);
}

/// A criterion on a group that no recording is in would never decide anything.
Result<void> check_groups(const Suite& suite) {
  std::vector<std::string> groups;
  for (const SuiteSimulation& simulation : suite.simulations) groups.push_back(simulation.group);
  for (const SuiteRecording& recording : suite.recordings) {
    // Without a group, recordings go by the names of their folders.
    if (recording.group.empty()) return {};
    groups.push_back(recording.group);
  }
  for (const Criterion& criterion : suite.criteria) {
    for (const std::string& group : criterion.groups) {
      if (suite.all || std::find(groups.begin(), groups.end(), group) != groups.end()) continue;
      return fail(ErrorCode::configuration, fmt::format("{}: no recording is in the group '{}'{}",
                                                        criterion.place, group, nearest_hint(group, groups)));
    }
  }
  return {};
}

Result<void> check_suite(const Suite& suite, const std::string& file) {
  const auto lacks = [&](std::string_view what) {
    return fail(ErrorCode::configuration, fmt::format("{}: {}", file, what));
  };
  if (suite.name.empty()) return lacks("the key 'name' is missing");
  if (suite.variants.empty() && suite.systems.empty())
    return lacks("the key 'variants' is missing, or 'systems' for external programs alone");
  const bool simulates = !suite.simulations.empty();
  if (suite.all ? !suite.recordings.empty() : suite.recordings.empty() && !simulates)
    return lacks("either 'recordings' or 'all = true' is needed, or [[simulations]]");
  if (auto good = check_groups(suite); !good) return good;
  // Each edit must be one that a configuration takes, before hours are spent on the runs before it.
  for (const std::string& name : variants_of(suite)) {
    const auto config = suite_config(suite, *config::find_variant(name));
    if (!config) return tl::unexpected(config.error());
    if (auto related = config::check_relations(config->values()); !related) {
      return lacks(fmt::format("variant {}: {}", name, related.error().message));
    }
  }
  return {};
}

Result<Suite> suite_of(const config::TomlDocument& document, const std::string& file) {
  constexpr std::array<std::string_view, 3> lists = {"recordings", "simulations", "criteria"};
  constexpr std::array<std::string_view, 2> lists_of_options = {"sweep",
                                                                "exclude"};  // with tables of their own
  for (const config::TomlTable& table : document.tables) {
    const auto list = list_of_key(table.key);
    const bool plain = list && std::find(lists.begin(), lists.end(), *list) != lists.end();
    const bool of_options =
        list && std::find(lists_of_options.begin(), lists_of_options.end(), *list) != lists_of_options.end();
    const bool known =
        list ? of_options || (plain && table.key.ends_with(']'))
             : table.key == "config" || table.key.starts_with(kConfigPrefix) || table.key == "limits";
    if (!known) return unknown_suite_key(table.place, table.key);
  }
  Suite suite;
  for (const config::TomlEntry& entry : document.entries) {
    if (auto read = read_entry(entry, suite); !read) return tl::unexpected(read.error());
  }
  if (auto read = read_tables(document, suite); !read) return tl::unexpected(read.error());
  if (auto complete = check_suite(suite, file); !complete) return tl::unexpected(complete.error());
  return suite;
}

}  // namespace

Result<Suite> read_suite(const fs::path& file) {
  const auto document = config::read_toml(file);
  if (!document) return tl::unexpected(document.error());
  return suite_of(*document, file.string());
}

Result<Suite> parse_suite(std::string_view text, const std::string& name) {
  const auto document = config::parse_toml(text, name);
  if (!document) return tl::unexpected(document.error());
  return suite_of(*document, name);
}

std::vector<std::string> variants_of(const Suite& suite) {
  std::vector<std::string> all = suite.variants;
  const auto add = [&](const std::vector<std::string>& more) {
    for (const std::string& name : more) {
      if (std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
    }
  };
  for (const SuiteRecording& recording : suite.recordings) add(recording.variants);
  for (const SuiteSimulation& simulation : suite.simulations) add(simulation.variants);
  return all;
}

Result<config::EffectiveConfig> suite_config(const Suite& suite, const config::Variant& variant) {
  config::EffectiveConfig config = config::variant_config(variant);
  for (const config::TomlEntry& entry : suite.config) {
    const auto* value = std::get_if<config::OptionValue>(&entry.value);
    if (value == nullptr) return wrong_entry(entry, "one value, not a list");
    if (auto set = config.set(entry.key, *value, entry.place); !set) return tl::unexpected(set.error());
  }
  return config;
}

Result<run::ImuChoice> parse_imu_choice(const std::string& text) {
  if (text == "recorded") return run::ImuChoice::recorded;
  if (text == "synthetic") return run::ImuChoice::synthetic;
  if (text == "auto") return run::ImuChoice::automatic;
  return fail(ErrorCode::configuration, fmt::format("imu = {} (allowed: recorded | synthetic | auto)", text));
}

}  // namespace fusebench::suites
