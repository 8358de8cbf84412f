#include "eval/suites/acceptance_criteria.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/nearest_name.hpp"
#include "core/config/variants.hpp"
#include "eval/record/registry/run_metric.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::suites {

namespace {

constexpr std::array<std::string_view, 18> kKeys = {
    "title",           "groups",       "split",         "variant",     "metric",        "statistic",
    "at_most",         "at_least",     "below",         "above",       "against",       "compare",
    "frames_above_px", "each_at_most", "each_at_least", "lost_counts", "within_bounds", "of_means"};

/// A table before its lists are multiplied out.
struct CriterionTable {
  Criterion criterion;
  std::vector<std::string> metrics;
  std::vector<std::string> variants;
  std::vector<std::string> against;
};

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

Result<void> check_metrics(const config::TomlEntry& entry, const std::vector<std::string>& names) {
  std::vector<std::string_view> known;
  for (const registry::RunMetric& metric : registry::run_metrics()) known.push_back(metric.key);
  for (const std::string& name : names) {
    if (registry::find_metric(name) != nullptr) continue;
    return fail(ErrorCode::configuration,
                fmt::format("{}: unknown metric '{}'{}", entry.place, name, nearest_hint(name, known)),
                "`fusebench list metrics` names them");
  }
  return {};
}

Result<void> read_number(const config::TomlEntry& entry, Criterion& criterion) {
  const std::array<std::pair<std::string_view, std::optional<double>*>, 7> numbers = {
      {{"at_most", &criterion.at_most},
       {"at_least", &criterion.at_least},
       {"below", &criterion.below},
       {"above", &criterion.above},
       {"frames_above_px", &criterion.frames_above_px},
       {"each_at_most", &criterion.each_at_most},
       {"each_at_least", &criterion.each_at_least}}};
  for (const auto& [name, number] : numbers) {
    if (entry.key == name) return store(number_entry(entry), *number);
  }
  return unknown_key(entry.place, entry.key, kKeys, "a criterion");
}

Result<void> read_split(const config::TomlEntry& entry, Criterion& criterion) {
  if (auto stored = store(text_entry(entry), criterion.split); !stored) return stored;
  if (!is_split(criterion.split)) return wrong_entry(entry, "\"tuning\" or \"held-out\"");
  return {};
}

Result<void> read_value(const config::TomlEntry& entry, CriterionTable& table) {
  Criterion& criterion = table.criterion;
  const std::string& key = entry.key;
  if (key == "title") return store(text_entry(entry), criterion.title);
  if (key == "groups") return store(names_entry(entry, true), criterion.groups);
  if (key == "split") return read_split(entry, criterion);
  if (key == "of_means") return store(flag_entry(entry), criterion.of_means);
  if (key == "lost_counts") return store(flag_entry(entry), criterion.lost_counts);
  if (key == "within_bounds") return store(flag_entry(entry), criterion.within_bounds);
  if (key == "variant") {
    if (auto stored = store(names_entry(entry, true), table.variants); !stored) return stored;
    return check_variants(entry, table.variants);
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
    return store_choice<CriterionStatistic, 4>(entry,
                                               {{{"worst", CriterionStatistic::worst},
                                                 {"mean", CriterionStatistic::mean},
                                                 {"median", CriterionStatistic::median},
                                                 {"share", CriterionStatistic::share}}},
                                               criterion.statistic);
  }
  if (key == "compare") {
    return store_choice<CriterionComparison, 2>(
        entry, {{{"ratio", CriterionComparison::ratio}, {"difference", CriterionComparison::difference}}},
        criterion.compare);
  }
  return read_number(entry, criterion);
}

/// What makes no sense together, as a sentence; nothing if all is well.
std::optional<std::string> contradiction(const Criterion& criterion, std::string_view reference) {
  const registry::RunMetric& metric = registry::run_metric(criterion.metric);
  const bool pairs = metric.takes_several_runs();
  const bool share = criterion.statistic == CriterionStatistic::share;
  const bool limited = criterion.has_upper() || criterion.has_lower();
  if (limited == criterion.within_bounds)
    return "one of at_most, below, at_least and above is needed, or within_bounds = true";
  if ((criterion.at_most && criterion.below) || (criterion.at_least && criterion.above))
    return "one limit on a side is enough";
  if (criterion.statistic == CriterionStatistic::worst && criterion.has_upper() && criterion.has_lower())
    return "statistic = \"worst\" takes a limit on one side";
  if (share != (criterion.each_at_most || criterion.each_at_least))
    return "each_at_most and each_at_least go with statistic = \"share\"";
  if (criterion.lost_counts && !share) return "lost_counts goes with statistic = \"share\"";
  if (criterion.within_bounds &&
      (metric.nees_dof == 0 || criterion.statistic != CriterionStatistic::mean || !criterion.against.empty()))
    return "within_bounds goes with a metric nees_* and statistic = \"mean\", without 'against'";
  if (criterion.of_means && (criterion.against.empty() || criterion.statistic != CriterionStatistic::mean))
    return "of_means goes with 'against' and statistic = \"mean\"";
  if (pairs && (criterion.against.empty() || criterion.variant == criterion.against ||
                (criterion.variant != reference && criterion.against != reference)))
    return fmt::format("{} compares a variant with {}: one is 'variant', the other 'against'",
                       criterion.metric, reference);
  if (criterion.frames_above_px && !(pairs && criterion.of_means))
    return fmt::format("frames_above_px goes with the metric {} and of_means = true",
                       registry::kCommonPixelsKey);
  return std::nullopt;
}

Result<void> add_criteria(const EntryTable& entries, std::string_view reference, CriterionTable table,
                          std::vector<Criterion>& criteria) {
  if (table.against.empty()) table.against = {""};
  const auto add = [&](const std::string& metric, const std::string& variant,
                       const std::string& against) -> Result<void> {
    Criterion criterion = table.criterion;
    criterion.metric = metric;
    criterion.variant = variant;
    criterion.against = against;
    if (table.metrics.size() > 1) criterion.title += fmt::format(": {}", metric);
    if (table.variants.size() > 1) criterion.title += fmt::format(" ({})", variant);
    if (table.against.size() > 1) criterion.title += fmt::format(" ({})", against);
    if (const auto wrong = contradiction(criterion, reference))
      return fail(ErrorCode::configuration, fmt::format("{}: {}", entries.place, *wrong));
    criteria.push_back(std::move(criterion));
    return {};
  };
  for (const std::string& metric : table.metrics) {
    for (const std::string& variant : table.variants) {
      for (const std::string& against : table.against) {
        if (auto added = add(metric, variant, against); !added) return added;
      }
    }
  }
  return {};
}

}  // namespace

Result<std::vector<Criterion>> read_criteria(const std::vector<EntryTable>& tables,
                                             std::string_view reference) {
  std::vector<Criterion> criteria;
  for (const EntryTable& entries : tables) {
    CriterionTable table;
    table.criterion.split = kHeldOutSplit;
    table.criterion.place = entries.place;
    for (const config::TomlEntry& entry : entries.entries) {
      if (auto read = read_value(entry, table); !read) return tl::unexpected(read.error());
    }
    for (const std::string_view key : {"title", "variant", "metric", "statistic"}) {
      if (entries.find(key) == nullptr)
        return fail(ErrorCode::configuration, fmt::format("{}: the key '{}' is missing", entries.place, key));
    }
    if (auto added = add_criteria(entries, reference, std::move(table), criteria); !added)
      return tl::unexpected(added.error());
  }
  return criteria;
}

}  // namespace fusebench::suites
