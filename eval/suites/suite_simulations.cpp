#include "eval/suites/suite_simulations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace fusebench::suites {

namespace {

constexpr std::array<std::string_view, 23> kKeys = {"name",
                                                    "format",
                                                    "preset",
                                                    "trajectory",
                                                    "speed",
                                                    "skip_s",
                                                    "realistic",
                                                    "start",
                                                    "seed",
                                                    "duration_s",
                                                    "rate_hz",
                                                    "size",
                                                    "exposure_s",
                                                    "blur_samples",
                                                    "no_noise",
                                                    "time_offset_s",
                                                    "rolling_shutter_s",
                                                    "group",
                                                    "variants",
                                                    "tuning_seeds",
                                                    "faults",
                                                    "calibration_error",
                                                    "untold_time_offset_s"};
/// These say how a recording is used; all others make it.
constexpr std::array<std::string_view, 4> kUse = {"name", "group", "variants", "tuning_seeds"};
/// A recording has the whole list of them.
constexpr std::string_view kFaults = "faults";
constexpr std::size_t kMostRecordings = 10000;

template <class List>
bool contains(const List& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

std::string shown(const config::OptionValue& value) {
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr) return *text;
  const auto* number = std::get_if<double>(&value);
  return number != nullptr ? fmt::format("{}", *number) : config::to_toml(value);
}

std::string shown(const config::TomlEntry& entry) {
  if (const auto* value = std::get_if<config::OptionValue>(&entry.value)) return shown(*value);
  std::string text;
  for (const config::OptionValue& value : std::get<config::TomlList>(entry.value))
    text += fmt::format("{}{}", text.empty() ? "" : " and ", shown(value));
  return text;
}

/// One value a key: a point of the product of lists.
using Assignments = std::vector<config::TomlEntry>;

Result<std::vector<Assignments>> multiplied(const EntryTable& table) {
  std::vector<Assignments> product = {{}};
  for (const config::TomlEntry& entry : table.entries) {
    if (contains(kUse, entry.key)) continue;
    const auto* list = std::get_if<config::TomlList>(&entry.value);
    if (entry.key == kFaults) {
      for (Assignments& begun : product) begun.push_back(entry);
      continue;
    }
    const config::TomlList values =
        list != nullptr ? *list : config::TomlList{std::get<config::OptionValue>(entry.value)};
    if (values.empty()) return wrong_entry(entry, "a value or a list that is not empty");
    std::vector<Assignments> longer;
    for (const Assignments& begun : product) {
      for (const config::OptionValue& value : values) {
        longer.push_back(begun);
        longer.back().push_back({entry.key, value, entry.place});
      }
    }
    product = std::move(longer);
    if (product.size() > kMostRecordings) {
      return fail(ErrorCode::configuration,
                  fmt::format("{}: more than {} recordings", entry.place, kMostRecordings));
    }
  }
  return product;
}

/// Puts the values of keys into a text with {key} in it.
Result<std::string> filled_in(const config::TomlEntry& pattern, const Assignments& values) {
  const auto text = text_entry(pattern);
  if (!text) return text;
  std::string result;
  for (std::size_t i = 0; i < text->size(); ++i) {
    if ((*text)[i] != '{') {
      result += (*text)[i];
      continue;
    }
    const std::size_t end = text->find('}', i);
    const std::string key = text->substr(i + 1, end == std::string::npos ? end : end - i - 1);
    const auto value = std::find_if(values.begin(), values.end(),
                                    [&](const config::TomlEntry& entry) { return entry.key == key; });
    if (end == std::string::npos || value == values.end()) {
      return fail(ErrorCode::configuration,
                  fmt::format("{}: {}: '{{{}}}' is no key of this table", pattern.place, pattern.key, key));
    }
    result += shown(*value);
    i = end;
  }
  return result;
}

Result<void> refused(const config::TomlEntry& entry, const Error& error) {
  return fail(error.code == ErrorCode::usage ? ErrorCode::configuration : error.code,
              fmt::format("{}: {}", entry.place, error.message), error.hint);
}

template <class T>
Result<void> store_parsed(const config::TomlEntry& entry, Result<T> (*parse)(std::string_view), T& target) {
  const auto text = text_entry(entry);
  if (!text) return tl::unexpected(text.error());
  const auto value = parse(*text);
  if (!value) return refused(entry, value.error());
  target = *value;
  return {};
}

Result<void> store_start(const config::TomlEntry& entry, SimulationRequest& request) {
  const auto text = plain_entry<std::string>(entry);
  if (!text || (*text != "rest" && *text != "motion")) return wrong_entry(entry, "\"rest\" or \"motion\"");
  request.from_rest = *text == "rest";
  return {};
}

Result<void> store_faults(const config::TomlEntry& entry, SimulationRequest& request) {
  auto faults = names_entry(entry, true);
  if (!faults) return tl::unexpected(faults.error());
  for (const std::string& fault : *faults) {
    if (const auto parsed = simulator::faults::parse_fault(fault); !parsed)
      return refused(entry, parsed.error());
  }
  request.faults = std::move(*faults);
  return {};
}

Result<void> store_calibration_error(const config::TomlEntry& entry, SimulationRequest& request) {
  const auto text = text_entry(entry);
  if (!text) return tl::unexpected(text.error());
  if (const auto parsed = simulator::faults::parse_calibration_error(*text); !parsed)
    return refused(entry, parsed.error());
  request.calibration_error = *text;
  return {};
}

Result<void> read_value(const config::TomlEntry& entry, SimulationRequest& request) {
  const std::string& key = entry.key;
  if (key == "format") return store_parsed(entry, parse_recording_layout, request.layout);
  if (key == "preset") return store_parsed(entry, parse_motion_preset, request.preset);
  if (key == "size") return store_parsed(entry, parse_image_size, request.size);
  if (key == "start") return store_start(entry, request);
  if (key == kFaults) return store_faults(entry, request);
  if (key == "calibration_error") return store_calibration_error(entry, request);
  if (key == "trajectory") return store(text_entry(entry), request.trajectory);
  if (key == "seed") return store(count_entry(entry), request.seed);
  if (key == "duration_s") return store(number_entry(entry), request.duration_s);
  if (key == "realistic") return store(flag_entry(entry), request.realistic);
  if (key == "no_noise") return store(flag_entry(entry), request.no_noise);
  if (key == "blur_samples") {
    const auto count = count_entry(entry);
    if (count && *count > 10000) return wrong_entry(entry, "an integer up to 10000");
    return store(count, request.blur_samples);
  }
  if (key == "exposure_s") return store(number_entry(entry), request.exposure_s);
  const std::array<std::pair<std::string_view, double*>, 6> numbers = {
      {{"speed", &request.speed},
       {"skip_s", &request.skip_s},
       {"rate_hz", &request.rate_hz},
       {"time_offset_s", &request.time_offset_s},
       {"rolling_shutter_s", &request.rolling_shutter_s},
       {"untold_time_offset_s", &request.untold_time_offset_s}}};
  for (const auto& [name, number] : numbers) {
    if (key == name) return store(number_entry(entry), *number);
  }
  return unknown_key(entry.place, key, kKeys, "a simulation");
}

Result<std::vector<std::uint64_t>> tuning_seeds(const EntryTable& table) {
  std::vector<std::uint64_t> seeds;
  const config::TomlEntry* entry = table.find("tuning_seeds");
  if (entry == nullptr) return seeds;
  const auto* list = std::get_if<config::TomlList>(&entry->value);
  if (list == nullptr) return wrong_entry(*entry, "a list of seeds");
  for (const config::OptionValue& value : *list) {
    const auto seed = count_entry({entry->key, value, entry->place});
    if (!seed) return wrong_entry(*entry, "a list of seeds");
    seeds.push_back(*seed);
  }
  return seeds;
}

Result<void> check_table(const EntryTable& table) {
  for (const config::TomlEntry& entry : table.entries) {
    if (!contains(kKeys, entry.key)) return unknown_key(entry.place, entry.key, kKeys, "a simulation");
  }
  const auto lacks = [&](std::string_view what) {
    return fail(ErrorCode::configuration, fmt::format("{}: {}", table.place, what));
  };
  if (table.find("name") == nullptr) return lacks("the key 'name' is missing");
  const bool preset = table.find("preset") != nullptr;
  const bool trajectory = table.find("trajectory") != nullptr;
  if (preset == trajectory) return lacks("either 'preset' or 'trajectory' is needed");
  if (trajectory && table.find("group") == nullptr)
    return lacks("with 'trajectory' the key 'group' is needed");
  for (const std::string_view key : {"speed", "skip_s"}) {
    if (!trajectory && table.find(key) != nullptr) return lacks(fmt::format("'{}' needs 'trajectory'", key));
  }
  return {};
}

Result<SuiteSimulation> simulation_of(const EntryTable& table, const Assignments& values,
                                      const std::vector<std::uint64_t>& tuning) {
  SuiteSimulation simulation;
  simulation.place = table.place;
  for (const config::TomlEntry& entry : values) {
    if (auto read = read_value(entry, simulation.request); !read) return tl::unexpected(read.error());
    simulation.described +=
        fmt::format("{}{} = {}", simulation.described.empty() ? "" : ", ", entry.key, shown(entry));
  }
  const config::TomlEntry& name = *table.find("name");
  auto filled = filled_in(name, values);
  if (!filled) return tl::unexpected(filled.error());
  if (auto good = check_folder_name(name, *filled); !good) return tl::unexpected(good.error());
  simulation.name = std::move(*filled);
  const config::TomlEntry* group = table.find("group");
  auto group_name =
      group == nullptr
          ? Result<std::string>(std::string(simulator::motion::to_string(simulation.request.preset)))
          : filled_in(*group, values);
  if (!group_name) return tl::unexpected(group_name.error());
  simulation.group = std::move(*group_name);
  const bool tunes = std::find(tuning.begin(), tuning.end(), simulation.request.seed) != tuning.end();
  simulation.split = tunes ? kTuningSplit : kHeldOutSplit;
  return simulation;
}

/// A second declaration of a recording only adds variants.
Result<void> add(SuiteSimulation simulation, std::vector<SuiteSimulation>& all) {
  const auto same = std::find_if(all.begin(), all.end(),
                                 [&](const SuiteSimulation& other) { return other.name == simulation.name; });
  if (same == all.end()) {
    all.push_back(std::move(simulation));
    return {};
  }
  if (same->described != simulation.described || same->group != simulation.group ||
      same->split != simulation.split) {
    return fail(ErrorCode::configuration,
                fmt::format("{}: '{}' is declared twice: at {} with {}, and here with {}", simulation.place,
                            simulation.name, same->place, same->described, simulation.described),
                "put a {key} for each list into the name");
  }
  if (same->place == simulation.place) {
    return fail(ErrorCode::configuration,
                fmt::format("{}: '{}' is made twice by this table", simulation.place, simulation.name),
                "does a list hold a value twice?");
  }
  for (std::string& variant : simulation.variants) {
    if (!contains(same->variants, variant)) same->variants.push_back(std::move(variant));
  }
  return {};
}

}  // namespace

Result<std::vector<SuiteSimulation>> read_simulations(const std::vector<EntryTable>& tables,
                                                      const std::vector<std::string>& suite_variants) {
  std::vector<SuiteSimulation> all;
  for (const EntryTable& table : tables) {
    if (auto good = check_table(table); !good) return tl::unexpected(good.error());
    std::vector<std::string> variants = suite_variants;
    if (const config::TomlEntry* entry = table.find("variants")) {
      auto list = variants_entry(*entry);
      if (!list) return tl::unexpected(list.error());
      variants = std::move(*list);
    }
    const auto tuning = tuning_seeds(table);
    if (!tuning) return tl::unexpected(tuning.error());
    const auto product = multiplied(table);
    if (!product) return tl::unexpected(product.error());
    for (const Assignments& values : *product) {
      auto simulation = simulation_of(table, values, *tuning);
      if (!simulation) return tl::unexpected(simulation.error());
      simulation->variants = variants;
      if (auto added = add(std::move(*simulation), all); !added) return tl::unexpected(added.error());
    }
  }
  return all;
}

}  // namespace fusebench::suites
