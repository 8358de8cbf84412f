#include "eval/compare/run_pairs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "core/config/config_access.hpp"
#include "core/config/toml_document.hpp"
#include "core/config/variants.hpp"

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

/// By recording, variant in the order of all_variants(), options, IMU, window.
auto order_of(const run_files::RunIdentity& experiment) {
  return std::tuple(experiment.recording, run_files::variant_rank(experiment.variant), experiment.variant,
                    options_text(experiment), experiment.imu, experiment.first_frame, experiment.frames);
}

bool never_opened(const std::vector<run_files::FoundRun>& runs) {
  return !runs.empty() && std::ranges::all_of(runs, [](const run_files::FoundRun& run) {
    return run.record.status == record::RunStatus::failed && run.record.recording.fingerprint.empty();
  });
}

bool alike(const run_files::RunIdentity& a, const run_files::RunIdentity& b) {
  return a.recording == b.recording && a.variant == b.variant && a.options == b.options;
}

/// Whether the runs of `lone`, which have no counterpart, belong to `pair`.
bool belongs(const RunPair& lone, const RunPair& pair) {
  if (!alike(lone.experiment, pair.experiment)) return false;
  const bool is_base = !lone.base.empty();
  const auto& own = is_base ? lone.base.runs : lone.fresh.runs;
  const auto& others = is_base ? pair.fresh.runs : pair.base.runs;
  if (others.empty()) return false;
  if (never_opened(own)) return true;
  const bool other_alone = (is_base ? pair.base : pair.fresh).empty();
  return other_alone && lone.experiment.first_frame == pair.experiment.first_frame &&
         lone.experiment.imu == pair.experiment.imu &&
         own.front().record.recording.fingerprint != others.front().record.recording.fingerprint &&
         lone.experiment.frames != pair.experiment.frames && !never_opened(others);
}

void move_runs(std::vector<run_files::FoundRun>& from, std::vector<run_files::FoundRun>& to) {
  for (run_files::FoundRun& run : from) to.push_back(std::move(run));
  from.clear();
  std::ranges::sort(to, {}, [](const run_files::FoundRun& run) { return run.folder.string(); });
}

/// The one pair that a run without a counterpart belongs to, if there is only one.
RunPair* only_pair_of(const RunPair& lone, std::vector<RunPair>& pairs) {
  RunPair* only = nullptr;
  for (RunPair& pair : pairs) {
    if (&pair == &lone || !belongs(lone, pair)) continue;
    if (only != nullptr) return nullptr;
    only = &pair;
  }
  return only;
}

void join_lone_runs(std::vector<RunPair>& pairs) {
  for (RunPair& lone : pairs) {
    if (lone.base.empty() == lone.fresh.empty()) continue;
    RunPair* only = only_pair_of(lone, pairs);
    if (only == nullptr) continue;
    move_runs(lone.base.runs, only->base.runs);
    move_runs(lone.fresh.runs, only->fresh.runs);
  }
  std::erase_if(pairs, [](const RunPair& pair) { return pair.base.empty() && pair.fresh.empty(); });
}

/// By its definition, whose default is not deterministic.
bool gives_same_bytes(const record::RunRecord& record) {
  if (!record.program) return true;
  const auto definition = config::parse_toml(record.program->definition, "definition");
  return definition && std::ranges::any_of(definition->entries, [](const config::TomlEntry& entry) {
           const bool* const value = config::plain_value<bool>(entry);
           return entry.key == "deterministic" && value != nullptr && *value;
         });
}

void set_replicates_apart(RunSide& side) {
  if (side.empty()) return;
  side.repeats_exactly = gives_same_bytes(side.front().record);
  if (!side.repeats_exactly) {
    side.replicates.assign(std::make_move_iterator(side.runs.begin() + 1),
                           std::make_move_iterator(side.runs.end()));
    side.runs.resize(1);
    return;
  }
  const auto replicate_of = [](const run_files::FoundRun& run) { return run.record.replicate; };
  const int first = std::ranges::min(side.runs, {}, replicate_of).record.replicate;
  const auto others = std::ranges::stable_partition(
      side.runs, [&](const run_files::FoundRun& run) { return run.record.replicate == first; });
  side.replicates.assign(std::make_move_iterator(others.begin()), std::make_move_iterator(others.end()));
  side.runs.erase(others.begin(), others.end());
  std::ranges::stable_sort(side.replicates, {}, replicate_of);
}

std::string short_label(const run_files::RunIdentity& experiment) {
  const std::string options =
      experiment.options.empty() ? "" : fmt::format(" [{}]", options_text(experiment));
  return fmt::format("{}/{}{}", experiment.recording, experiment.variant, options);
}

void set_labels(std::vector<RunPair>& pairs) {
  std::map<std::string, std::size_t> uses;
  for (const RunPair& pair : pairs) ++uses[short_label(pair.experiment)];
  for (RunPair& pair : pairs) {
    pair.label = short_label(pair.experiment);
    if (uses[pair.label] < 2) continue;
    pair.label += fmt::format(" (frames {}:{}, IMU: {})", pair.experiment.first_frame,
                              pair.experiment.first_frame + pair.experiment.frames, pair.experiment.imu);
  }
}

/// Keys of the options that differ; nothing if the experiments differ in anything else.
std::optional<std::set<std::string>> only_options(const run_files::RunIdentity& a,
                                                  const run_files::RunIdentity& b) {
  const auto but_options = [](const run_files::RunIdentity& e) {
    return std::tie(e.recording, e.variant, e.imu, e.first_frame, e.frames);
  };
  if (but_options(a) != but_options(b)) return std::nullopt;
  run_files::RunOptions differing;
  std::ranges::set_symmetric_difference(a.options, b.options, std::back_inserter(differing));
  std::set<std::string> keys;
  for (const auto& [key, value] : differing) keys.insert(key);
  return keys;
}

/// Whether only the variants differ; which IMU is used belongs to a variant.
bool only_variant(const run_files::RunIdentity& a, const run_files::RunIdentity& b) {
  return a.variant != b.variant && std::tie(a.recording, a.options, a.first_frame, a.frames) ==
                                       std::tie(b.recording, b.options, b.first_frame, b.frames);
}

}  // namespace

bool is_ignored(const IgnoredOptions& ignored, std::string_view key) {
  return std::ranges::any_of(ignored, [&](const std::string& name) {
    return key == name || (name.ends_with('.') && key.starts_with(name));
  });
}

std::size_t RunSide::replicate_count() const {
  if (!repeats_exactly) return runs.size() + replicates.size();
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

run_files::RunIdentity experiment_of(const run_files::FoundRun& run, const IgnoredOptions& ignored) {
  run_files::RunIdentity experiment = run_files::without_repetition(run_files::identity_of(run));
  experiment.fingerprint.clear();
  experiment.config_hash.clear();
  experiment.data.clear();
  experiment.truth.clear();
  const config::EffectiveConfig defaults = defaults_of(experiment.variant);
  for (const record::RecordedOption& option : run.record.config) {
    if (run_files::is_edit(option.origin) && !is_ignored(ignored, option.key) &&
        !is_default(defaults, option))
      experiment.options.emplace_back(option.key, config::to_toml(option.value));
  }
  std::ranges::sort(experiment.options);
  return experiment;
}

std::string options_text(const run_files::RunIdentity& experiment) {
  std::vector<std::string> options;
  for (const auto& [key, value] : experiment.options) options.push_back(fmt::format("{}={}", key, value));
  return fmt::format("{}", fmt::join(options, ", "));
}

std::vector<RunPair> pair_runs(std::vector<run_files::FoundRun> base, std::vector<run_files::FoundRun> fresh,
                               const IgnoredOptions& ignored) {
  std::map<decltype(order_of(run_files::RunIdentity{})), RunPair> by_experiment;
  for (const auto& [runs, side] : {std::pair(&base, &RunPair::base), std::pair(&fresh, &RunPair::fresh)}) {
    for (run_files::FoundRun& run : *runs) {
      const run_files::RunIdentity experiment = experiment_of(run, ignored);
      RunPair& pair = by_experiment[order_of(experiment)];
      pair.experiment = experiment;
      (pair.*side).runs.push_back(std::move(run));
    }
    runs->clear();
  }
  std::vector<RunPair> pairs;
  for (auto& [order, pair] : by_experiment) {
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

std::vector<std::string> unpaired_notes(std::span<const RunPair> pairs) {
  std::set<std::string> keys;
  std::set<std::string> variants;
  for (const RunPair& base : pairs) {
    if (!base.fresh.empty()) continue;
    std::optional<std::set<std::string>> fewest;
    std::set<std::string> others;
    for (const RunPair& fresh : pairs) {
      if (!fresh.base.empty()) continue;
      auto differing = only_options(base.experiment, fresh.experiment);
      if (differing && (!fewest || differing->size() < fewest->size())) fewest = std::move(differing);
      if (only_variant(base.experiment, fresh.experiment))
        others.insert(fmt::format("{} and {}", base.experiment.variant, fresh.experiment.variant));
    }
    if (fewest) {
      keys.merge(*fewest);
    } else {
      variants.merge(others);
    }
  }
  std::vector<std::string> notes;
  if (!keys.empty())
    notes.push_back(
        fmt::format("runs of BASE and NEW differ only in options: {}; --ignore-options {} pairs them",
                    fmt::join(keys, ", "), fmt::join(keys, " --ignore-options ")));
  if (!variants.empty())
    notes.push_back(
        fmt::format("runs of BASE and NEW differ only in the variant ({}): `compare` pairs runs of equal "
                    "variants; `fusebench best` and `fusebench report` compare the variants of one folder",
                    fmt::join(variants, ", ")));
  return notes;
}

}  // namespace fusebench::compare
