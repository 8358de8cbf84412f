#include "eval/compare/comparison.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "eval/record/record.hpp"
#include "eval/record/registry/run_numbers.hpp"
#include "eval/record/run_files/record_files.hpp"
#include "eval/record/run_files/run_identity.hpp"

namespace fusebench::compare {

namespace {

std::string status_text(const record::RunRecord& record) {
  return record.reason.empty() ? std::string(record::to_string(record.status))
                               : fmt::format("{} ({})", record::to_string(record.status), record.reason);
}

GateResult status_gate(const record::RunRecord& base, const record::RunRecord& fresh, const Gates& gates) {
  const std::string change = fmt::format("{} -> {}", status_text(base), status_text(fresh));
  if (fresh.status < base.status) return regression("status", change);
  if (fresh.status > base.status)
    return {"status", GateVerdict::improvement, gates.improvements_fail, change};
  if (fresh.status == record::RunStatus::ok) return {"status", GateVerdict::unchanged, false, {}};
  return note("status", fmt::format("both {}: {}", record::to_string(fresh.status), fresh.reason));
}

std::string change_text(double base, double fresh, std::string_view unit) {
  std::string text = fmt::format("{} -> {} ({}{}", quantity_text(base, unit), quantity_text(fresh, unit),
                                 fresh > base ? "+" : "", quantity_text(fresh - base, unit));
  if (base != 0) text += fmt::format(", {:+.3g} %", 100 * (fresh - base) / std::abs(base));
  return text + ")";
}

GateResult metric_gate(const registry::RunMetric& metric, const MetricTolerance& tolerance,
                       const record::Outcome<double>& base, const record::Outcome<double>& fresh,
                       const Gates& gates) {
  GateResult result = number_gate(metric, tolerance, base.value, fresh.value);
  if (!fresh.value) {
    result.verdict = GateVerdict::regression;
    result.fails = true;
    result.message = fmt::format("{} -> none: {}", quantity_text(*base.value, metric.unit), fresh.reason);
  } else if (!base.value) {
    result.verdict = GateVerdict::note;
    result.message = fmt::format("new: {}; the baseline has none: {}",
                                 quantity_text(*fresh.value, metric.unit), base.reason);
  } else if (std::abs(*fresh.value - *base.value) > *result.tolerance) {
    judge_change(result, gates);
    result.message = fmt::format("{}, tolerance {}", change_text(*base.value, *fresh.value, metric.unit),
                                 quantity_text(*result.tolerance, metric.unit));
  }
  return result;
}

void add_metric_gates(const RunPair& pair, const Gates& gates, std::vector<GateResult>& results) {
  for (std::size_t i = 0; i < gated_metrics().size(); ++i) {
    const registry::RunMetric& metric = *gated_metrics()[i];
    const auto base = registry::number_of(pair.base.front().record, metric);
    const auto fresh = registry::number_of(pair.fresh.front().record, metric);
    if (!base.value && !fresh.value) continue;
    const auto tolerance = gates.tolerance(i, pair.experiment.recording, pair.experiment.variant);
    results.push_back(metric_gate(metric, tolerance, base, fresh, gates));
  }
}

/// How a repetition differs from the first run of its side; empty if it does not.
std::string difference(const run_files::FoundRun& first, const run_files::FoundRun& other) {
  if (first.record.status != other.record.status)
    return fmt::format("status {} and {}", status_text(first.record), status_text(other.record));
  if (first.record.recording.fingerprint != other.record.recording.fingerprint)
    return "the recording's content";
  const registry::RunNumbers a_numbers = registry::numbers_of(first.record);
  const registry::RunNumbers b_numbers = registry::numbers_of(other.record);
  for (const registry::RunMetric* metric : gated_metrics()) {
    const auto a = a_numbers[*metric];
    const auto b = b_numbers[*metric];
    if (a == b) continue;
    const auto text = [&](const std::optional<double>& v) {
      return v ? fmt::format("{} {}", *v, metric->unit) : "none";
    };
    return fmt::format("{} is {} and {}", metric->key, text(a), text(b));
  }
  if (!has_trajectory(first.folder) || !has_trajectory(other.folder)) return {};
  const auto divergence = first_divergence(first.folder, other.folder);
  if (!divergence) return divergence.error().message;
  return *divergence ? fmt::format("the trajectory {}", (*divergence)->text()) : std::string();
}

void add_repetition_gates(const RunPair& pair, const Gates& gates, std::vector<GateResult>& results) {
  for (const auto& [side, runs] : {std::pair("BASE", &pair.base.runs), std::pair("NEW", &pair.fresh.runs)}) {
    for (std::size_t i = 1; i < runs->size(); ++i) {
      const std::string differs = difference(runs->front(), (*runs)[i]);
      if (differs.empty()) continue;
      const std::string text = fmt::format("repetitions of {} differ: {} ({} and {})", side, differs,
                                           runs->front().folder.string(), (*runs)[i].folder.string());
      results.push_back(gates.repetitions_fail ? regression("repetitions", text) : note("repetitions", text));
      break;
    }
  }
  const bool repeated = pair.base.runs.size() > 1 || pair.fresh.runs.size() > 1;
  const bool differ =
      std::ranges::any_of(results, [](const GateResult& r) { return r.gate == "repetitions"; });
  if (repeated && !differ) results.push_back({"repetitions", GateVerdict::unchanged, false, {}});
}

void add_divergence(ComparedRun& run, const Gates& gates) {
  const run_files::FoundRun& base = run.runs.base.front();
  const run_files::FoundRun& fresh = run.runs.fresh.front();
  if (!has_trajectory(base.folder)) {
    if (has_trajectory(fresh.folder))
      run.gates.push_back(note("trajectory", "BASE keeps no trajectory to compare"));
    return;
  }
  if (!has_trajectory(fresh.folder)) {
    run.gates.push_back(regression("trajectory", "NEW has no trajectory.tum, and BASE has one"));
    return;
  }
  auto divergence = first_divergence(base.folder, fresh.folder);
  if (!divergence) {
    run.gates.push_back(regression("trajectory", divergence.error().message));
    return;
  }
  run.divergence = std::move(*divergence);
  run.is_identical = !run.divergence.has_value();
  GateResult result{"trajectory", GateVerdict::unchanged, false, {}};
  if (run.divergence) {
    const std::string text = "the trajectory " + run.divergence->text();
    result = gates.divergence_fails ? regression("trajectory", text) : note("trajectory", text);
  }
  run.gates.push_back(std::move(result));
}

/// A run that never opened its recording does not know its content.
bool other_data(const record::RunRecord& base, const record::RunRecord& fresh) {
  const std::string& before = base.recording.fingerprint;
  const std::string& after = fresh.recording.fingerprint;
  return !before.empty() && !after.empty() && before != after;
}

std::string other_data_text(const record::RunRecord& base, const record::RunRecord& fresh) {
  const record::RecordedRecording& before = base.recording;
  const record::RecordedRecording& after = fresh.recording;
  return fmt::format(
      "the data{} changed: not comparable (fingerprint {}, {} frames -> {}, {} frames); run both over "
      "the same recording and --frames, or {}",
      before.frames == after.frames ? "" : " or the frame window", before.fingerprint, before.frames,
      after.fingerprint, after.frames, kUpdate);
}

/// The same simulation, which mathematical libraries may round differently on another CPU.
bool simulated_anew(const record::RunRecord& base, const record::RunRecord& fresh) {
  const record::RecordedRecording& before = base.recording;
  const record::RecordedRecording& after = fresh.recording;
  return before.data == "simulated" && after.data == "simulated" && before.frames == after.frames;
}

void add_timed_gates(ComparedRun& run, const Gates& gates, const std::vector<run_files::FoundRun>& confirming,
                     const IgnoredOptions& ignored) {
  const auto is_ok = [](const RunSide& side) { return side.front().record.status == record::RunStatus::ok; };
  if (!is_ok(run.runs.base) || !is_ok(run.runs.fresh)) return;
  std::vector<run_files::FoundRun> again;
  for (const run_files::FoundRun& found : confirming) {
    if (experiment_of(found, ignored) == run.runs.experiment) again.push_back(found);
  }
  for (GateResult& result : timed_gates(run.runs, gates, again, !confirming.empty()))
    run.gates.push_back(std::move(result));
}

ComparedRun compare_pair(RunPair pair, const Gates& gates, const std::vector<run_files::FoundRun>& confirming,
                         const IgnoredOptions& ignored) {
  ComparedRun run{std::move(pair), {}, std::nullopt, false};
  if (run.runs.fresh.empty()) {
    run.gates.push_back(regression("run", "missing in NEW"));
    return run;
  }
  if (run.runs.base.empty()) {
    run.gates.push_back(
        note("run", fmt::format("new, no baseline: {}", status_text(run.runs.fresh.front().record))));
    return run;
  }
  run.gates.push_back({"run", GateVerdict::unchanged, false, {}});
  const record::RunRecord& base = run.runs.base.front().record;
  const record::RunRecord& fresh = run.runs.fresh.front().record;
  if (!other_data(base, fresh)) {
    run.gates.push_back({"data", GateVerdict::unchanged, false, {}});
  } else if (!gates.changed_simulation_fails && simulated_anew(base, fresh)) {
    run.gates.push_back(note("data", "simulated anew, with other bytes: compared all the same"));
  } else {
    run.gates.push_back(regression("data", other_data_text(base, fresh)));
    return run;
  }
  const bool repeats_exactly = run.runs.base.repeats_exactly && run.runs.fresh.repeats_exactly;
  const bool by_replicates = !repeats_exactly || has_replicates_to_gate(run.runs, gates);
  if (!by_replicates) run.gates.push_back(status_gate(base, fresh, gates));
  for (GateResult& result : config_gates(base, fresh, gates, ignored)) run.gates.push_back(std::move(result));
  add_repetition_gates(run.runs, gates, run.gates);
  if (by_replicates) {
    for (GateResult& result : replicate_gates(run.runs, gates)) run.gates.push_back(std::move(result));
    if (repeats_exactly && base.replicate == fresh.replicate && base.status == fresh.status &&
        base.status != record::RunStatus::failed)
      add_divergence(run, gates);
    add_timed_gates(run, gates, confirming, ignored);
    return run;
  }
  // Where one side failed the other's numbers would only repeat it.
  if (base.status != record::RunStatus::failed && fresh.status != record::RunStatus::failed) {
    if (fresh.status == base.status) add_metric_gates(run.runs, gates, run.gates);
    add_divergence(run, gates);
  }
  add_timed_gates(run, gates, confirming, ignored);
  return run;
}

void add_unused_overrides(const Gates& gates, RunComparison& comparison) {
  for (const GateOverride& gate : gates.overrides) {
    const bool used = std::ranges::any_of(comparison.runs, [&](const ComparedRun& run) {
      return gate.is_for(run.runs.experiment.recording, run.runs.experiment.variant);
    });
    if (!used)
      comparison.notes.push_back(fmt::format("{}: this override is for none of the runs", gate.place));
  }
}

/// Of records that were compared.
void release_details(RunPair& pair) {
  for (RunSide* const side : {&pair.base, &pair.fresh}) {
    for (auto* const runs : {&side->runs, &side->replicates}) {
      for (run_files::FoundRun& run : *runs) {
        run.record.config = {};
        run.record.timing.histograms = {};
      }
    }
  }
}

/// Whether the records and trajectories are what the runs wrote.
Result<void> check_undamaged(std::span<const run_files::FoundRun> runs) {
  for (const run_files::FoundRun& run : runs) {
    if (run.state != run_files::RunState::whole)
      return fail(ErrorCode::data_corrupt, (run.folder / run.record.reason).string());
    if (!has_trajectory(run.folder)) continue;
    if (auto checked = run_files::check_file(run.folder, run.record, "trajectory.tum"); !checked)
      return fail(checked.error().code, (run.folder / checked.error().message).string());
  }
  return {};
}

bool knows(const std::vector<run_files::FoundRun>& runs, const std::string& key) {
  return std::ranges::any_of(runs, [&](const run_files::FoundRun& run) {
    return std::ranges::any_of(run.record.config, [&](const record::RecordedOption& option) {
      return is_ignored({key}, option.key);
    });
  });
}

}  // namespace

GateResult regression(std::string gate, std::string message) {
  return {std::move(gate), GateVerdict::regression, true, std::move(message)};
}

GateResult note(std::string gate, std::string message) {
  return {std::move(gate), GateVerdict::note, false, std::move(message)};
}

std::string_view to_string(GateVerdict verdict) {
  switch (verdict) {
    case GateVerdict::regression:
      return "REGRESSION";
    case GateVerdict::changed:
      return "CHANGED";
    case GateVerdict::improvement:
      return "IMPROVEMENT";
    case GateVerdict::suspect:
      return "POSSIBLE SLOWDOWN";
    case GateVerdict::note:
      return "note";
    case GateVerdict::unchanged:
      break;
  }
  return "unchanged";
}

GateResult number_gate(const registry::RunMetric& metric, const MetricTolerance& tolerance,
                       std::optional<double> base, std::optional<double> fresh) {
  GateResult gate{
      std::string(metric.key), GateVerdict::unchanged, false, {}, std::string(metric.unit), base, fresh};
  if (base) gate.tolerance = std::max(tolerance.absolute, tolerance.relative * std::abs(*base));
  gate.better = tolerance.better;
  return gate;
}

void judge_change(GateResult& gate, const Gates& gates) {
  const bool is_better = (*gate.fresh < *gate.base) == (gate.better == registry::Better::smaller);
  gate.verdict = gate.better == registry::Better::neither ? GateVerdict::changed
                 : is_better                              ? GateVerdict::improvement
                                                          : GateVerdict::regression;
  gate.fails = gate.verdict != GateVerdict::improvement || gates.improvements_fail;
}

bool RunComparison::passed() const { return failures() == 0; }

std::size_t RunComparison::count(GateVerdict verdict) const {
  std::size_t number = 0;
  for (const ComparedRun& run : runs) {
    for (const GateResult& gate : run.gates) {
      if (gate.verdict == verdict) ++number;
    }
  }
  return number;
}

std::size_t RunComparison::failures() const {
  std::size_t number = 0;
  for (const ComparedRun& run : runs) {
    for (const GateResult& gate : run.gates) {
      if (gate.fails) ++number;
    }
  }
  return number;
}

std::size_t RunComparison::identical() const {
  std::size_t number = 0;
  for (const ComparedRun& run : runs) {
    if (run.is_identical) ++number;
  }
  return number;
}

std::vector<const ComparedRun*> RunComparison::diverging() const {
  std::vector<const ComparedRun*> result;
  for (const ComparedRun& run : runs) {
    if (run.divergence) result.push_back(&run);
  }
  std::ranges::stable_sort(result, {}, [](const ComparedRun* run) { return run->divergence->frame; });
  return result;
}

Result<RunComparison> compare_runs(std::vector<run_files::FoundRun> base,
                                   std::vector<run_files::FoundRun> fresh, const Gates& gates,
                                   const std::vector<run_files::FoundRun>& confirming,
                                   const IgnoredOptions& ignored) {
  for (const auto* runs : {&std::as_const(base), &std::as_const(fresh), &confirming}) {
    if (auto checked = check_undamaged(*runs); !checked) return tl::unexpected(checked.error());
  }
  RunComparison comparison;
  for (const std::string& key : ignored)
    if (!knows(base, key) && !knows(fresh, key))
      comparison.notes.push_back(fmt::format("no run has an ignored option '{}'", key));
  // Records are large, and there may be thousands: none is copied, and what no format shows is released.
  std::vector<RunPair> pairs = pair_runs(std::move(base), std::move(fresh), ignored);
  for (std::string& text : unpaired_notes(pairs)) comparison.notes.push_back(std::move(text));
  for (RunPair& pair : pairs) {
    comparison.runs.push_back(compare_pair(std::move(pair), gates, confirming, ignored));
    release_details(comparison.runs.back().runs);
  }
  add_unused_overrides(gates, comparison);
  const bool is_worse =
      comparison.count(GateVerdict::regression) > 0 || comparison.count(GateVerdict::suspect) > 0;
  const bool differs =
      comparison.count(GateVerdict::improvement) > 0 || comparison.count(GateVerdict::changed) > 0;
  if (differs && !is_worse)
    comparison.notes.push_back(fmt::format("no regression; if the changes are intended, {}", kUpdate));
  return comparison;
}

}  // namespace fusebench::compare
