#include "eval/compare/gates.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "core/base/nearest_name.hpp"
#include "core/config/toml_document.hpp"
#include "eval/compare/rank_test.hpp"
#include "eval/suites/suite_entries.hpp"

namespace fusebench::compare {

namespace {

constexpr std::array<std::string_view, 9> kTopKeys = {
    "improvements", "changed_defaults", "changed_simulation", "repetitions", "divergence", "tolerance",
    "metrics",      "timing",           "overrides"};
constexpr std::size_t kFirstTable = 5;
constexpr std::array<std::string_view, 2> kToleranceKeys = {"relative", "absolute"};
constexpr std::array<std::string_view, 3> kMetricKeys = {"relative", "absolute", "better"};
constexpr std::array<std::string_view, 3> kTimingKeys = {"alpha", "min_repetitions", "factors"};
constexpr std::array<std::string_view, 6> kOverrideKeys = {"recordings", "variants", "metrics",
                                                           "relative",   "absolute", "factor"};

bool matches(const std::string& pattern, std::string_view name) {
  if (!pattern.ends_with('*')) return pattern == name;
  return name.starts_with(std::string_view(pattern).substr(0, pattern.size() - 1));
}

bool any_matches(const std::vector<std::string>& patterns, std::string_view name) {
  return patterns.empty() ||
         std::ranges::any_of(patterns, [&](const std::string& pattern) { return matches(pattern, name); });
}

bool lists(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

/// Counts are exact unless gates name them.
bool is_count(const registry::RunMetric& metric) { return metric.kind == registry::MetricKind::count; }

std::vector<std::string_view> metric_keys() {
  std::vector<std::string_view> keys;
  for (const registry::RunMetric* metric : gated_metrics()) keys.push_back(metric->key);
  return keys;
}

std::vector<std::string_view> timed_keys() {
  std::vector<std::string_view> keys;
  for (const registry::RunMetric* cost : gated_costs()) keys.push_back(cost->key);
  return keys;
}

/// The place of a name in a list, or an error with the nearest one.
Result<std::size_t> index_of(const std::string& name, const std::vector<std::string_view>& known,
                             const std::string& place) {
  const auto found = std::ranges::find(known, name);
  if (found != known.end()) return static_cast<std::size_t>(found - known.begin());
  return fail(ErrorCode::configuration,
              fmt::format("{}: unknown metric '{}'{}", place, name, nearest_hint(name, known)),
              fmt::format("they are {}", fmt::join(known, ", ")));
}

template <class Target>
Result<void> store_number(const config::TomlEntry& entry, double least, double most, Target& target) {
  const auto number = suites::number_entry(entry);
  if (!number) return tl::unexpected(number.error());
  if (*number < least || *number > most)
    return suites::wrong_entry(entry, fmt::format("a number in {:g} .. {:g}", least, most));
  target = *number;
  return {};
}

constexpr double kMostRelative = 10;
constexpr double kMostAbsolute = 1e9;
constexpr double kMostFactor = 100;

template <class Target>
Result<void> store_limit(const config::TomlEntry& entry, std::string_view key, Target& target) {
  return key == "relative" ? store_number(entry, 0, kMostRelative, target.relative)
                           : store_number(entry, 0, kMostAbsolute, target.absolute);
}

Result<void> store_fails(const config::TomlEntry& entry, bool& fails) {
  const auto text = suites::plain_entry<std::string>(entry).value_or("");
  if (text != "fail" && text != "report") return suites::wrong_entry(entry, "\"fail\" or \"report\"");
  fails = text == "fail";
  return {};
}

Result<void> read_better(const config::TomlEntry& entry, registry::Better& better) {
  const auto text = suites::plain_entry<std::string>(entry).value_or("");
  using enum registry::Better;
  for (const registry::Better value : {smaller, larger, neither}) {
    if (text != to_string(value)) continue;
    better = value;
    return {};
  }
  return suites::wrong_entry(entry, "\"smaller\", \"larger\" or \"equal\"");
}

/// The key after "tolerance.".
Result<void> read_tolerance(const config::TomlEntry& entry, const std::string& key, Gates& gates) {
  if (!lists({kToleranceKeys.begin(), kToleranceKeys.end()}, key))
    return suites::unknown_key(entry.place, entry.key, kToleranceKeys, "[tolerance]");
  for (std::size_t i = 0; i < gates.tolerances.size(); ++i) {
    if (is_count(*gated_metrics()[i])) continue;
    if (auto stored = store_limit(entry, key, gates.tolerances[i]); !stored) return stored;
  }
  return {};
}

/// The key after "metrics.": the metric and what of it.
Result<void> read_metric(const config::TomlEntry& entry, const std::string& key, Gates& gates) {
  const auto dot = key.find('.');
  const auto index = index_of(key.substr(0, dot), metric_keys(), entry.place);
  if (!index) return tl::unexpected(index.error());
  const std::string what = dot == std::string::npos ? "" : key.substr(dot + 1);
  MetricTolerance& tolerance = gates.tolerances[*index];
  if (what == "better") return read_better(entry, tolerance.better);
  if (what == "relative" || what == "absolute") return store_limit(entry, what, tolerance);
  return suites::unknown_key(entry.place, what, kMetricKeys, "a metric");
}

/// The key after "timing.".
Result<void> read_timing(const config::TomlEntry& entry, const std::string& key, Gates& gates) {
  constexpr std::string_view kFactors = "factors.";
  if (key.starts_with(kFactors)) {
    const auto index = index_of(key.substr(kFactors.size()), timed_keys(), entry.place);
    if (!index) return tl::unexpected(index.error());
    return store_number(entry, 1, kMostFactor, gates.factors[*index]);
  }
  if (key == "alpha") return store_number(entry, 1e-12, 0.5, gates.alpha);
  if (key == "min_repetitions") {
    const auto count = suites::count_entry(entry);
    if (!count) return tl::unexpected(count.error());
    if (*count < 2 || *count > 1000) return suites::wrong_entry(entry, "an integer in 2 .. 1000");
    gates.min_repetitions = *count;
    return {};
  }
  return suites::unknown_key(entry.place, key, kTimingKeys, "[timing]");
}

Result<void> read_entry(const config::TomlEntry& entry, Gates& gates) {
  const std::string& key = entry.key;
  if (key == "improvements") return store_fails(entry, gates.improvements_fail);
  if (key == "changed_defaults") return store_fails(entry, gates.changed_defaults_fail);
  if (key == "changed_simulation") return store_fails(entry, gates.changed_simulation_fails);
  if (key == "repetitions") return store_fails(entry, gates.repetitions_fail);
  if (key == "divergence") return store_fails(entry, gates.divergence_fails);
  const auto dot = key.find('.');
  const std::string table = key.substr(0, dot);
  const std::string rest = dot == std::string::npos ? "" : key.substr(dot + 1);
  if (table == "tolerance") return read_tolerance(entry, rest, gates);
  if (table == "metrics") return read_metric(entry, rest, gates);
  if (table == "timing") return read_timing(entry, rest, gates);
  return suites::unknown_key(entry.place, key, kTopKeys, "gates");
}

Result<void> store_names(const config::TomlEntry& entry, std::vector<std::string>& names) {
  auto read = suites::names_entry(entry, true);
  if (!read) return tl::unexpected(read.error());
  names = std::move(*read);
  return {};
}

Result<void> read_override_entry(const config::TomlEntry& entry, GateOverride& gate) {
  if (entry.key == "recordings") return store_names(entry, gate.recordings);
  if (entry.key == "variants") return store_names(entry, gate.variants);
  if (entry.key == "relative" || entry.key == "absolute") return store_limit(entry, entry.key, gate);
  if (entry.key == "factor") return store_number(entry, 1, kMostFactor, gate.factor);
  if (entry.key != "metrics")
    return suites::unknown_key(entry.place, entry.key, kOverrideKeys, "[[overrides]]");
  if (auto stored = store_names(entry, gate.metrics); !stored) return stored;
  std::vector<std::string_view> known = metric_keys();
  for (const std::string_view key : timed_keys()) known.push_back(key);
  for (const std::string& name : gate.metrics) {
    if (const auto index = index_of(name, known, entry.place); !index) return tl::unexpected(index.error());
  }
  return {};
}

Result<void> read_overrides(const config::TomlDocument& document, Gates& gates) {
  for (const suites::EntryTable& table : suites::entry_tables(document, "overrides")) {
    GateOverride gate;
    gate.place = table.place;
    for (const config::TomlEntry& entry : table.entries) {
      if (auto read = read_override_entry(entry, gate); !read) return read;
    }
    if (!gate.relative && !gate.absolute && !gate.factor)
      return fail(ErrorCode::configuration, fmt::format("{}: an override that changes nothing", table.place),
                  "give it relative, absolute or factor");
    gates.overrides.push_back(std::move(gate));
  }
  return {};
}

Result<void> check_tables(const config::TomlDocument& document) {
  for (const config::TomlTable& table : document.tables) {
    const std::string name = table.key.substr(0, table.key.find_first_of(".["));
    if (!lists({kTopKeys.begin() + kFirstTable, kTopKeys.end()}, name))
      return suites::unknown_key(table.place, name, kTopKeys, "gates");
  }
  return {};
}

Result<Gates> gates_of(const config::TomlDocument& document, const std::string& name) {
  Gates gates;
  if (auto sound = check_tables(document); !sound) return tl::unexpected(sound.error());
  // What holds for all metrics comes first, wherever it stands.
  for (const bool of_all : {true, false}) {
    for (const config::TomlEntry& entry : document.entries) {
      if (suites::list_of_key(entry.key) == "overrides" || entry.key.starts_with("tolerance.") != of_all)
        continue;
      if (auto read = read_entry(entry, gates); !read) return tl::unexpected(read.error());
    }
  }
  if (auto read = read_overrides(document, gates); !read) return tl::unexpected(read.error());
  if (least_p(gates.min_repetitions) >= gates.alpha) {
    return fail(ErrorCode::configuration,
                fmt::format("{}: timing.alpha = {:g} cannot be reached with timing.min_repetitions = {} "
                            "(the least p of so many is {:.2g})",
                            name, gates.alpha, gates.min_repetitions, least_p(gates.min_repetitions)),
                "ask for more repetitions or a larger alpha");
  }
  return gates;
}

}  // namespace

bool GateOverride::is_for(std::string_view recording, std::string_view variant) const {
  return any_matches(recordings, recording) && any_matches(variants, variant);
}

Gates::Gates() {
  for (const registry::RunMetric* metric : gated_metrics())
    tolerances.push_back({*metric->tolerance, 0, metric->better});
  for (const registry::RunMetric* cost : gated_costs()) factors.push_back(1 + *cost->tolerance);
}

MetricTolerance Gates::tolerance(std::size_t metric, std::string_view recording,
                                 std::string_view variant) const {
  const registry::RunMetric& gated = *gated_metrics()[metric];
  MetricTolerance result = tolerances[metric];
  for (const GateOverride& gate : overrides) {
    const bool meant = gate.metrics.empty() ? !is_count(gated) : lists(gate.metrics, gated.key);
    if (!meant || !gate.is_for(recording, variant)) continue;
    result.relative = gate.relative.value_or(result.relative);
    result.absolute = gate.absolute.value_or(result.absolute);
  }
  return result;
}

double Gates::factor(std::size_t quantity, std::string_view recording, std::string_view variant) const {
  double result = factors[quantity];
  for (const GateOverride& gate : overrides) {
    const bool meant = gate.metrics.empty() || lists(gate.metrics, gated_costs()[quantity]->key);
    if (meant && gate.is_for(recording, variant)) result = gate.factor.value_or(result);
  }
  return result;
}

Result<Gates> read_gates(const std::filesystem::path& file) {
  const auto document = config::read_toml(file);
  if (!document) return tl::unexpected(document.error());
  return gates_of(*document, file.string());
}

Result<Gates> parse_gates(std::string_view text, const std::string& name) {
  const auto document = config::parse_toml(text, name);
  if (!document) return tl::unexpected(document.error());
  return gates_of(*document, name);
}

}  // namespace fusebench::compare
