#include "eval/compare/aggregate/best.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include "eval/record/data_labels.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/option_order.hpp"

namespace fusebench::aggregate {

namespace {

/// In the order in which groups are shown: variants as tables list them, numbers by value.
struct GroupKey {
  std::string kind;
  std::size_t rank = 0;
  std::string label;

  bool operator<(const GroupKey& other) const {
    if (kind != other.kind) return kind < other.kind;
    if (rank != other.rank) return rank < other.rank;
    return run_files::OptionValueLess()(label, other.label);
  }
};

GroupKey key_of(const RunRow& row, const std::string& group, const std::string& kind) {
  if (group == "none") return {kind, 0, "all"};
  if (group == "recording") return {kind, 0, row.recorded_part()};
  if (group == "variant") return {kind, run_files::variant_rank(row.variant), row.variant};
  return {kind, 0, std::string(option_of(row, group))};
}

Result<void> check_group(const std::string& group, const std::vector<std::string>& edited) {
  if (group == "none" || group == "recording" || group == "variant") return {};
  if (std::ranges::find(edited, group) != edited.end()) return {};
  return fail(ErrorCode::usage,
              fmt::format("--group {}: no run edits this option (allowed: recording | variant | none{}{})",
                          group, edited.empty() ? "" : " | ", fmt::join(edited, " | ")));
}

void rank(std::vector<BestRow>& rows) {
  // Stable: configurations that are equal stay in the order of variants and options.
  std::ranges::stable_sort(rows, [](const BestRow& a, const BestRow& b) {
    const auto key = [](const ConfigurationSummary& c) {
      return std::tuple(!c.complete(), c.failed.size() + c.not_run.size(), !c.mean, !c.ratio.tied,
                        c.ratio.ratio.value_or(c.mean.value_or(0)));
    };
    return key(a.configuration) < key(b.configuration);
  });
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const ConfigurationSummary& own = rows[i].configuration;
    if (!own.mean) continue;
    // Without ratios one before is better if its whole range is, which without replicates is its mean.
    const auto is_better = [&](const BestRow& before) {
      const ConfigurationSummary& other = before.configuration;
      if (!own.complete() || !other.complete()) return true;
      if (!own.ratio.ratio || !other.ratio.ratio) return other.spread->most < own.spread->least;
      return !own.ratio.tied && (other.ratio.tied || *other.ratio.ratio < *own.ratio.ratio);
    };
    rows[i].rank = 1 + static_cast<std::size_t>(std::count_if(
                           rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(i), is_better));
  }
}

std::string label_of(const ConfigurationSummary& configuration, const BestGroup& group) {
  std::string label = configuration.variant;
  for (const auto& [key, value] : configuration.options) label += fmt::format(" {}={}", key, value);
  const bool imus = std::ranges::any_of(
      group.rows, [&](const BestRow& row) { return row.configuration.imu != configuration.imu; });
  return imus ? fmt::format("{} ({})", label, configuration.imu) : label;
}

/// "1.41 times the best of each recording (95 % interval 1.00 to 2.00)".
std::string ratio_text(const RatioMean& ratio) {
  const std::string interval = ratio.interval ? fmt::format("95 % interval {:.2f} to {:.2f}",
                                                            (*ratio.interval)[0], (*ratio.interval)[1])
                                              : "one recording without replicates: no interval";
  return fmt::format("{:.2f} times the best of each recording ({})", ratio.ratio.value_or(1), interval);
}

/// What a number does not show of an order of several configurations; empty: nothing.
std::string caveat_of(const BestGroup& group, const registry::RunMetric& metric) {
  if (metric.key != "aie_grey" || group.rows.size() < 2) return "";
  return " An AIE is of the pixels that a configuration tracked: configurations that track other pixels do "
         "not "
         "compare. `fusebench table` has the AIE on common pixels.";
}

/// rows: ranked, all of them.
std::string headline_of(const BestGroup& group, const registry::RunMetric& metric) {
  constexpr std::size_t kMostNamed = 6;
  const ConfigurationSummary& best = group.rows.front().configuration;
  const std::string where = fmt::format("{} ({}, {} recording{})", group.label, group.kind,
                                        group.recordings.size(), group.recordings.size() == 1 ? "" : "s");
  if (!best.complete())
    return fmt::format("{}: no configuration has {} on all recordings.", where, metric.key);
  if (!best.ratio.ratio)
    return fmt::format("{}: {} has the smallest mean; no ratios, since a {} is not positive.", where,
                       label_of(best, group), metric.key);
  std::string text = fmt::format("{}: {} is best by {}: {}.", where, label_of(best, group), metric.key,
                                 ratio_text(best.ratio));
  std::vector<std::string> ties;
  for (const BestRow& row : std::span(group.rows).subspan(1)) {
    if (row.rank == 1)
      ties.push_back(
          fmt::format("{} ({:.2f})", label_of(row.configuration, group), *row.configuration.ratio.ratio));
  }
  if (ties.empty()) return text;
  const std::size_t more = ties.size() - std::min(ties.size(), kMostNamed);
  ties.resize(ties.size() - more);
  return text + fmt::format(" Tied with it: {}{}.", fmt::join(ties, ", "),
                            more > 0 ? fmt::format(" and {} more", more) : "");
}

std::vector<std::string> notes_of(std::span<const RunRow> rows, const registry::RunMetric& metric,
                                  const std::set<std::string>& without_number) {
  std::vector<std::string> notes;
  if (const std::size_t damaged = unreadable_count(rows); damaged > 0)
    notes.push_back(fmt::format(
        "{} of {} records cannot be read and are left out: `fusebench list runs FOLDER` says why.", damaged,
        rows.size()));
  const auto unknown =
      std::ranges::count_if(rows, [](const RunRow& row) { return row.readable && !row.options_known; });
  if (unknown > 0) {
    notes.push_back(fmt::format(
        "{} failed runs never wrote their options and are left out: no other run has their configuration.",
        unknown));
  }
  if (!without_number.empty()) {
    notes.push_back(
        fmt::format("No run has {} of {}: left out.", metric.key, fmt::join(without_number, ", ")));
  }
  notes.push_back(fmt::format(
      "{}: mean over a group's recordings of the median over their ok runs; less is better. Of replicates "
      "[B, C] is "
      "the range of that mean. Times the best: geometric mean over recordings of the ratio to the smallest "
      "median of the recording, with its 95 % interval (bootstrap over recordings and replicates, not "
      "corrected for picking the best of several). Rank 1: the smallest ratio, and those whose ratio to it "
      "has an interval that contains 1. "
      "Configurations that lost, failed or did not run some of them come after those that did all; "
      "their means are of fewer recordings and do not compare.",
      metric.key));
  if (std::ranges::any_of(rows, [](const RunRow& row) { return !row.window.empty(); }))
    notes.emplace_back("Of recordings of which parts were run, each window is a recording here.");
  std::vector<record::DataWords> words;
  for (const RunRow& row : rows) words.push_back({row.data, row.imu, row.truth});
  for (std::string& footnote : record::data_footnotes(words)) notes.push_back(std::move(footnote));
  return notes;
}

}  // namespace

std::string incomplete_note(const ConfigurationSummary& configuration) {
  std::string note;
  const auto add = [&](const char* what, const std::vector<std::string>& recordings) {
    if (!recordings.empty())
      note += fmt::format("{}{}: {}", note.empty() ? "" : "; ", what, fmt::join(recordings, ", "));
  };
  add("failed or lost", configuration.failed);
  add("without this number", configuration.without_number);
  add("not run", configuration.not_run);
  return note;
}

Result<BestTable> best_configurations(std::span<const RunRow> rows, const BestRequest& request) {
  check(request.metric != nullptr && request.metric->better == registry::Better::smaller,
        "a metric that ranks");
  BestTable table{request.metric, request.group, edited_options(rows), {}, {}};
  if (auto allowed = check_group(request.group, table.options); !allowed)
    return tl::unexpected(allowed.error());
  const auto kinds =
      recording_kinds(rows, request.group == "recording" ? KindsBy::data : KindsBy::data_and_imu);
  std::map<GroupKey, std::vector<const RunRow*>> members;
  std::set<std::string> whole;  // recordings, whose parts are no further samples
  for (const RunRow& row : rows) {
    if (row.window.empty()) whole.insert(row.recording);
  }
  for (const RunRow& row : rows) {
    const bool repeats = !row.window.empty() && whole.contains(row.recording);
    const std::string kind = kinds.at(row.recording) + (repeats ? ", parts of recordings" : "");
    if (row.attributable()) members[key_of(row, request.group, kind)].push_back(&row);
  }
  std::set<std::string> without_number;
  for (const auto& [key, runs] : members) {
    ConfigurationSummaries summaries = summarise_configurations(runs, *request.metric);
    without_number.insert(summaries.without_number.begin(), summaries.without_number.end());
    if (summaries.configurations.empty()) continue;
    BestGroup group{key.label, key.kind, std::move(summaries.recordings), "", 0, {}};
    for (ConfigurationSummary& summary : summaries.configurations)
      group.rows.push_back({std::nullopt, std::move(summary)});
    group.configurations = group.rows.size();
    rank(group.rows);
    group.headline = headline_of(group, *request.metric) + caveat_of(group, *request.metric);
    if (request.most > 0 && group.rows.size() > request.most)
      group.rows.erase(group.rows.begin() + static_cast<std::ptrdiff_t>(request.most), group.rows.end());
    table.groups.push_back(std::move(group));
  }
  table.notes = notes_of(rows, *request.metric, without_number);
  return table;
}

}  // namespace fusebench::aggregate
