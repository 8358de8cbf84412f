#include "eval/compare/run_pairs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/config/config_access.hpp"
#include "core/config/toml_document.hpp"
#include "core/config/variants.hpp"
#include "eval/run_files/run_labels.hpp"

namespace fusebench::compare {

namespace {

/// Of a variant of this program; of another one the plain ones.
config::EffectiveConfig defaults_of(const std::string& variant) {
  const auto found = config::find_variant(variant);
  return found ? config::variant_config(*found) : config::EffectiveConfig{};
}

bool is_default(const config::EffectiveConfig& defaults, const record::RecordedOption& option) {
  config::EffectiveConfig set = defaults;
  return config::set_option(set.values(), option.key, option.value) &&
         config::config_hash(set.values()) == config::config_hash(defaults.values());
}

auto order_of(const RunKey& key) {
  return std::tuple(key.recording, run_files::variant_rank(key.variant), key.variant, key.options, key.imu,
                    key.first_frame, key.frames);
}

bool never_opened(const std::vector<run_files::FoundRun>& runs) {
  return !runs.empty() && std::ranges::all_of(runs, [](const run_files::FoundRun& run) {
    return run.record.status == record::RunStatus::failed && run.record.recording.fingerprint.empty();
  });
}

bool alike(const RunKey& a, const RunKey& b) {
  return a.recording == b.recording && a.variant == b.variant && a.options == b.options;
}

/// Whether the runs of `lone`, which have no counterpart, belong to `pair`.
bool belongs(const RunPair& lone, const RunPair& pair) {
  if (!alike(lone.key, pair.key)) return false;
  const bool is_base = !lone.base.empty();
  const auto& own = is_base ? lone.base.runs : lone.fresh.runs;
  const auto& others = is_base ? pair.fresh.runs : pair.base.runs;
  if (others.empty()) return false;
  if (never_opened(own)) return true;
  const bool other_alone = (is_base ? pair.base : pair.fresh).empty();
  return other_alone && lone.key.first_frame == pair.key.first_frame && lone.key.imu == pair.key.imu &&
         own.front().record.recording.fingerprint != others.front().record.recording.fingerprint &&
         lone.key.frames != pair.key.frames && !never_opened(others);
}

void move_runs(std::vector<run_files::FoundRun>& from, std::vector<run_files::FoundRun>& to) {
  for (run_files::FoundRun& run : from) to.push_back(std::move(run));
  from.clear();
  std::ranges::sort(to, {}, [](const run_files::FoundRun& run) { return run.folder.string(); });
}

/// A run whose record says nothing has no options to be known by, but the name of its folder.
bool has_same_folder(const RunPair& lone, const RunPair& pair) {
  const auto& own = lone.base.empty() ? lone.fresh.runs : lone.base.runs;
  const auto& others = lone.base.empty() ? pair.base.runs : pair.fresh.runs;
  return lone.key.recording == pair.key.recording && lone.key.variant == pair.key.variant &&
         std::ranges::all_of(own, [&](const run_files::FoundRun& run) {
           if (run.state == run_files::RunState::whole || !run.record.config.empty()) return false;
           return std::ranges::any_of(others, [&](const run_files::FoundRun& other) {
             return other.folder.filename() == run.folder.filename();
           });
         });
}

/// The one pair that a run without a counterpart belongs to, if there is only one.
template <class Belongs>
RunPair* only_pair_of(const RunPair& lone, std::vector<RunPair>& pairs, const Belongs& is_one) {
  RunPair* only = nullptr;
  for (RunPair& pair : pairs) {
    if (&pair == &lone || !is_one(lone, pair)) continue;
    if (only != nullptr) return nullptr;
    only = &pair;
  }
  return only;
}

void join_lone_runs(std::vector<RunPair>& pairs) {
  for (RunPair& lone : pairs) {
    if (lone.base.empty() == lone.fresh.empty()) continue;
    RunPair* only = only_pair_of(lone, pairs, has_same_folder);
    if (only == nullptr) only = only_pair_of(lone, pairs, belongs);
    if (only == nullptr) continue;
    move_runs(lone.base.runs, only->base.runs);
    move_runs(lone.fresh.runs, only->fresh.runs);
  }
  std::erase_if(pairs, [](const RunPair& pair) { return pair.base.empty() && pair.fresh.empty(); });
}

void set_replicates_apart(RunSide& side) {
  if (side.empty()) return;
  const auto replicate_of = [](const run_files::FoundRun& run) { return run.record.replicate; };
  const int first = std::ranges::min(side.runs, {}, replicate_of).record.replicate;
  const auto others = std::ranges::stable_partition(
      side.runs, [&](const run_files::FoundRun& run) { return run.record.replicate == first; });
  side.replicates.assign(std::make_move_iterator(others.begin()), std::make_move_iterator(others.end()));
  side.runs.erase(others.begin(), others.end());
  std::ranges::stable_sort(side.replicates, {}, replicate_of);
}

std::string short_label(const RunKey& key) {
  const std::string options = key.options.empty() ? "" : fmt::format(" [{}]", key.options);
  return fmt::format("{}/{}{}", key.recording, key.variant, options);
}

void set_labels(std::vector<RunPair>& pairs) {
  std::map<std::string, std::size_t> uses;
  for (const RunPair& pair : pairs) ++uses[short_label(pair.key)];
  for (RunPair& pair : pairs) {
    pair.label = short_label(pair.key);
    if (uses[pair.label] < 2) continue;
    pair.label += fmt::format(" (frames {}:{}, IMU: {})", pair.key.first_frame,
                              pair.key.first_frame + pair.key.frames, pair.key.imu);
  }
}

}  // namespace

std::size_t RunSide::replicate_count() const {
  std::set<int> different;
  for (const run_files::FoundRun* run : all()) different.insert(run->record.replicate);
  return different.size();
}

std::vector<const run_files::FoundRun*> RunSide::all() const {
  std::vector<const run_files::FoundRun*> all;
  for (const auto* part : {&runs, &replicates}) {
    for (const run_files::FoundRun& run : *part) all.push_back(&run);
  }
  return all;
}

RunKey key_of(const record::RunRecord& record) {
  std::vector<std::string> options;
  const config::EffectiveConfig defaults = defaults_of(record.variant);
  for (const record::RecordedOption& option : record.config) {
    // Whoever sets an option to what it is anyway asks for the same run as who does not.
    if (run_files::is_edit(option.origin) && !is_default(defaults, option))
      options.push_back(fmt::format("{}={}", option.key, config::to_toml(option.value)));
  }
  std::ranges::sort(options);
  return {record.recording.name,   record.variant,       record.recording.first_frame,
          record.recording.frames, record.recording.imu, fmt::format("{}", fmt::join(options, ", "))};
}

std::vector<RunPair> pair_runs(const std::vector<run_files::FoundRun>& base,
                               const std::vector<run_files::FoundRun>& fresh) {
  std::map<decltype(order_of(RunKey{})), RunPair> by_key;
  for (const auto& [runs, side] : {std::pair(&base, &RunPair::base), std::pair(&fresh, &RunPair::fresh)}) {
    for (const run_files::FoundRun& run : *runs) {
      const RunKey key = key_of(run.record);
      RunPair& pair = by_key[order_of(key)];
      pair.key = key;
      (pair.*side).runs.push_back(run);
    }
  }
  std::vector<RunPair> pairs;
  for (auto& [order, pair] : by_key) {
    for (RunSide* side : {&pair.base, &pair.fresh})
      std::ranges::sort(side->runs, {}, [](const run_files::FoundRun& run) { return run.folder.string(); });
    pairs.push_back(std::move(pair));
  }
  join_lone_runs(pairs);
  for (RunPair& pair : pairs) {
    for (RunSide* side : {&pair.base, &pair.fresh}) set_replicates_apart(*side);
  }
  set_labels(pairs);
  return pairs;
}

}  // namespace fusebench::compare
