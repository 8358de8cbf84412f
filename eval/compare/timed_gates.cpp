// Times and memory are never the same twice: a ratio of medians must be large and the ranks must agree that
// it is no chance, and a rerun must see it again.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "eval/compare/comparison.hpp"
#include "eval/compare/rank_test.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/record/registry/run_numbers.hpp"

namespace fusebench::compare {

namespace {

std::vector<double> numbers_of(std::span<const run_files::FoundRun* const> runs,
                               const registry::RunMetric& quantity) {
  std::vector<double> numbers;
  for (const run_files::FoundRun* run : runs) {
    if (const auto value = registry::number_of(run->record, quantity).value) numbers.push_back(*value);
  }
  return numbers;
}

/// What makes times of two groups of runs not comparable; empty if nothing does.
std::string different_machines(std::span<const run_files::FoundRun* const> base,
                               std::span<const run_files::FoundRun* const> fresh) {
  std::set<std::string> hosts;
  std::set<std::string> cpus;
  std::set<int> threads;
  for (const auto runs : {base, fresh}) {
    for (const run_files::FoundRun* run : runs) {
      hosts.insert(run->record.provenance.host);
      cpus.insert(run->record.provenance.cpu);
      threads.insert(run->record.provenance.threads);
    }
  }
  if (cpus.size() > 1) return "other CPU models";
  if (hosts.size() > 1) return "other hosts";
  if (threads.size() > 1) return "other numbers of threads";
  return {};
}

struct TimedTest {
  bool gated = false;
  std::string why_not;
  double base = 0;  // medians
  double fresh = 0;
  RankTest slower;
  RankTest faster;

  [[nodiscard]] double ratio() const { return fresh / base; }
};

TimedTest test_of(std::span<const run_files::FoundRun* const> base,
                  std::span<const run_files::FoundRun* const> fresh, const registry::RunMetric& quantity,
                  const Gates& gates) {
  const std::vector<double> before = numbers_of(base, quantity);
  const std::vector<double> after = numbers_of(fresh, quantity);
  TimedTest test;
  test.base = metrics::statistics(before).median;
  test.fresh = metrics::statistics(after).median;
  test.slower = test_larger(before, after);
  test.faster = test_larger(after, before);
  const std::size_t fewest = std::min(before.size(), after.size());
  test.why_not = different_machines(base, fresh);
  if (test.why_not.empty() && fewest < gates.min_repetitions) {
    test.why_not =
        fmt::format("{} repetition{}; {} are needed", fewest, fewest == 1 ? "" : "s", gates.min_repetitions);
  }
  test.gated = test.why_not.empty();
  return test;
}

bool is_slower(const TimedTest& test, double factor, double alpha) {
  return test.gated && test.ratio() > factor && test.slower.p < alpha;
}

/// The verdict on what looks slower.
void judge_slower(const RunPair& pair, const registry::RunMetric& quantity, const Gates& gates, double factor,
                  std::span<const run_files::FoundRun> confirming, bool confirmation_given,
                  GateResult& result) {
  result.verdict = GateVerdict::suspect;
  result.fails = true;
  if (!confirmation_given) {
    result.message += "; confirm it: run NEW again and give that folder to --confirm";
    return;
  }
  if (confirming.empty()) {
    result.message += "; not confirmed: --confirm has no such run";
    return;
  }
  std::vector<const run_files::FoundRun*> rerun;
  for (const run_files::FoundRun& run : confirming) rerun.push_back(&run);
  const TimedTest again = test_of(pair.base.all(), rerun, quantity, gates);
  if (!again.gated) {
    result.message += fmt::format("; not confirmed: the rerun is not gated: {}", again.why_not);
  } else if (is_slower(again, factor, gates.alpha)) {
    result.verdict = GateVerdict::regression;
    result.message += fmt::format("; confirmed by the rerun: {:.6g} {}, ratio {:.3f}, p = {:.2g}",
                                  again.fresh, quantity.unit, again.ratio(), again.slower.p);
  } else {
    result.verdict = GateVerdict::note;
    result.fails = false;
    result.message += fmt::format("; cleared by the rerun: {:.6g} {}, ratio {:.3f}, p = {:.2g}", again.fresh,
                                  quantity.unit, again.ratio(), again.slower.p);
  }
}

}  // namespace

std::vector<GateResult> timed_gates(const RunPair& pair, const Gates& gates,
                                    std::span<const run_files::FoundRun> confirming,
                                    bool confirmation_given) {
  std::vector<GateResult> results;
  const std::vector<const run_files::FoundRun*> base = pair.base.all();
  const std::vector<const run_files::FoundRun*> fresh = pair.fresh.all();
  for (std::size_t i = 0; i < gated_costs().size(); ++i) {
    const registry::RunMetric& quantity = *gated_costs()[i];
    if (numbers_of(base, quantity).empty() || numbers_of(fresh, quantity).empty()) continue;
    const TimedTest test = test_of(base, fresh, quantity, gates);
    const double factor = gates.factor(i, pair.experiment.recording, pair.experiment.variant);
    GateResult result =
        number_gate(quantity, {factor - 1, 0, registry::Better::smaller}, test.base, test.fresh);
    const std::string change = fmt::format("{:.6g} {} -> {:.6g} {} (ratio {:.3f})", test.base, quantity.unit,
                                           test.fresh, quantity.unit, test.ratio());
    if (!test.gated) {
      result.verdict = GateVerdict::note;
      result.message = fmt::format("{}, not gated: {}", change, test.why_not);
      result.not_gated = test.why_not;
    } else if (result.p = test.slower.p; is_slower(test, factor, gates.alpha)) {
      result.message = fmt::format("{}, above the factor {:g} with p = {:.2g} < {:g}", change, factor,
                                   test.slower.p, gates.alpha);
      judge_slower(pair, quantity, gates, factor, confirming, confirmation_given, result);
    } else if (test.ratio() * factor < 1 && test.faster.p < gates.alpha) {
      result.verdict = GateVerdict::note;
      result.message = fmt::format("{}, better with p = {:.2g}", change, test.faster.p);
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace fusebench::compare
