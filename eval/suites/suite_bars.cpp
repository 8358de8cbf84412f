#include "eval/suites/suite_bars.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "core/config/variants.hpp"
#include "eval/suites/study_values.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::suites {

namespace {

constexpr std::array<std::string_view, 18> kKeys = {
    "title",           "groups",       "half",          "variant",     "metric",        "statistic",
    "at_most",         "at_least",     "below",         "above",       "against",       "compare",
    "frames_above_px", "each_at_most", "each_at_least", "lost_counts", "within_bounds", "of_means"};

/// A table before its lists are multiplied out.
struct BarTable {
  Bar bar;
  std::vector<std::string> metrics;
  std::vector<std::string> against;
};

template <class T>
Result<void> store(Result<T> value, auto& target) {
  if (!value) return tl::unexpected(value.error());
  target = std::move(*value);
  return {};
}

template <class Choice, std::size_t N>
Result<void> store_choice(const config::TomlEntry& entry,
                          const std::array<std::pair<std::string_view, Choice>, N>& choices, Choice& target) {
  const auto text = plain_entry<std::string>(entry).value_or("");
  std::vector<std::string_view> names;
  for (const auto& [name, choice] : choices) {
    names.push_back(name);
    if (text != name) continue;
    target = choice;
    return {};
  }
  return wrong_entry(entry, fmt::format("one of {}", fmt::join(names, ", ")));
}

Result<void> check_variants(const config::TomlEntry& entry, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const auto variant = config::find_variant(name);
    if (!variant)
      return fail(ErrorCode::configuration, fmt::format("{}: {}", entry.place, variant.error().message),
                  variant.error().hint);
  }
  return {};
}

Result<void> check_metrics(const config::TomlEntry& entry, const std::vector<std::string>& names) {
  std::vector<std::string_view> known;
  for (const StudyValue& value : study_values()) known.push_back(value.name);
  for (const std::string& name : names) {
    if (find_study_value(name) != nullptr) continue;
    return fail(
        ErrorCode::configuration,
        fmt::format("{}: unknown metric '{}' (nearest: {})", entry.place, name, nearest_name(name, known)),
        fmt::format("metrics are {}", fmt::join(known, ", ")));
  }
  return {};
}

Result<void> read_number(const config::TomlEntry& entry, Bar& bar) {
  const std::array<std::pair<std::string_view, std::optional<double>*>, 7> numbers = {
      {{"at_most", &bar.at_most},
       {"at_least", &bar.at_least},
       {"below", &bar.below},
       {"above", &bar.above},
       {"frames_above_px", &bar.frames_above_px},
       {"each_at_most", &bar.each_at_most},
       {"each_at_least", &bar.each_at_least}}};
  for (const auto& [name, number] : numbers) {
    if (entry.key == name) return store(number_entry(entry), *number);
  }
  return unknown_key(entry.place, entry.key, kKeys, "a bar");
}

Result<void> read_half(const config::TomlEntry& entry, Bar& bar) {
  if (auto stored = store(text_entry(entry), bar.half); !stored) return stored;
  if (bar.half != kTuningHalf && bar.half != kHeldOutHalf)
    return wrong_entry(entry, "\"tuning\" or \"held-out\"");
  return {};
}

Result<void> read_value(const config::TomlEntry& entry, BarTable& table) {
  Bar& bar = table.bar;
  const std::string& key = entry.key;
  if (key == "title") return store(text_entry(entry), bar.title);
  if (key == "groups") return store(names_entry(entry, true), bar.groups);
  if (key == "half") return read_half(entry, bar);
  if (key == "of_means") return store(flag_entry(entry), bar.of_means);
  if (key == "lost_counts") return store(flag_entry(entry), bar.lost_counts);
  if (key == "within_bounds") return store(flag_entry(entry), bar.within_bounds);
  if (key == "variant") {
    if (auto stored = store(text_entry(entry), bar.variant); !stored) return stored;
    return check_variants(entry, {bar.variant});
  }
  if (key == "against") {
    if (auto stored = store(names_entry(entry, true), table.against); !stored) return stored;
    return check_variants(entry, table.against);
  }
  if (key == "metric") {
    if (auto stored = store(names_entry(entry, true), table.metrics); !stored) return stored;
    return check_metrics(entry, table.metrics);
  }
  if (key == "statistic") {
    return store_choice<BarStatistic, 4>(entry,
                                         {{{"worst", BarStatistic::worst},
                                           {"mean", BarStatistic::mean},
                                           {"median", BarStatistic::median},
                                           {"share", BarStatistic::share}}},
                                         bar.statistic);
  }
  if (key == "compare") {
    return store_choice<BarComparison, 2>(
        entry, {{{"ratio", BarComparison::ratio}, {"difference", BarComparison::difference}}}, bar.compare);
  }
  return read_number(entry, bar);
}

/// What makes no sense together, as a sentence; nothing if all is well.
std::optional<std::string> contradiction(const Bar& bar, std::string_view reference) {
  const StudyValue& value = *find_study_value(bar.metric);
  const bool pairs = value.of == nullptr;
  const bool share = bar.statistic == BarStatistic::share;
  const bool limited = bar.has_upper() || bar.has_lower();
  if (limited == bar.within_bounds)
    return "one of at_most, below, at_least and above is needed, or within_bounds = true";
  if ((bar.at_most && bar.below) || (bar.at_least && bar.above)) return "one limit on a side is enough";
  if (bar.statistic == BarStatistic::worst && bar.has_upper() && bar.has_lower())
    return "statistic = \"worst\" takes a limit on one side";
  if (share != (bar.each_at_most || bar.each_at_least))
    return "each_at_most and each_at_least go with statistic = \"share\"";
  if (bar.lost_counts && !share) return "lost_counts goes with statistic = \"share\"";
  if (bar.within_bounds &&
      (value.nees_dof == 0 || bar.statistic != BarStatistic::mean || !bar.against.empty()))
    return "within_bounds goes with a metric nees_* and statistic = \"mean\", without 'against'";
  if (bar.of_means && (bar.against.empty() || bar.statistic != BarStatistic::mean))
    return "of_means goes with 'against' and statistic = \"mean\"";
  if (pairs && (bar.against.empty() || bar.variant == bar.against ||
                (bar.variant != reference && bar.against != reference)))
    return fmt::format("{} compares a variant with {}: one is 'variant', the other 'against'", bar.metric,
                       reference);
  if (bar.frames_above_px && !(pairs && bar.of_means))
    return fmt::format("frames_above_px goes with the metric {} and of_means = true", kCommonPixelsValue);
  return std::nullopt;
}

Result<void> add_bars(const EntryTable& entries, std::string_view reference, BarTable table,
                      std::vector<Bar>& bars) {
  if (table.against.empty()) table.against = {""};
  for (const std::string& metric : table.metrics) {
    for (const std::string& against : table.against) {
      Bar bar = table.bar;
      bar.metric = metric;
      bar.against = against;
      if (table.metrics.size() > 1) bar.title += fmt::format(": {}", metric);
      if (table.against.size() > 1) bar.title += fmt::format(" ({})", against);
      if (const auto wrong = contradiction(bar, reference))
        return fail(ErrorCode::configuration, fmt::format("{}: {}", entries.place, *wrong));
      bars.push_back(std::move(bar));
    }
  }
  return {};
}

}  // namespace

Result<std::vector<Bar>> read_bars(const std::vector<EntryTable>& tables, std::string_view reference) {
  std::vector<Bar> bars;
  for (const EntryTable& entries : tables) {
    BarTable table;
    table.bar.half = kHeldOutHalf;
    table.bar.place = entries.place;
    for (const config::TomlEntry& entry : entries.entries) {
      if (auto read = read_value(entry, table); !read) return tl::unexpected(read.error());
    }
    for (const std::string_view key : {"title", "variant", "metric", "statistic"}) {
      if (entries.find(key) == nullptr)
        return fail(ErrorCode::configuration, fmt::format("{}: the key '{}' is missing", entries.place, key));
    }
    if (auto added = add_bars(entries, reference, std::move(table), bars); !added)
      return tl::unexpected(added.error());
  }
  return bars;
}

}  // namespace fusebench::suites
