// With replicates a number is a distribution: it is worse only if chance does not explain the difference.
#include <fmt/format.h>

#include <algorithm>

#include "eval/compare/comparison.hpp"
#include "eval/record/registry/replicated_numbers.hpp"

namespace fusebench::compare {

namespace {

using registry::MedianRange;

std::vector<registry::RunNumbers> numbers_of(const RunSide& side) {
  std::vector<registry::RunNumbers> numbers;
  for (const run_files::FoundRun* run : side.all()) {
    if (run->record.status == record::RunStatus::ok) numbers.push_back(registry::numbers_of(run->record));
  }
  return numbers;
}

/// Whether the ranges are further apart than either is wide. Of 40,000 pairs of five numbers each from one
/// normal, log-normal or Cauchy distribution none is; of one with two equally likely values 0.2 % are.
bool are_apart(const MedianRange& a, const MedianRange& b) {
  const double gap = std::max(b.least - a.most, a.least - b.most);
  return gap > std::max(a.most - a.least, b.most - b.least);
}

std::string range_text(const MedianRange& range, std::string_view unit) {
  return fmt::format("{} [{:.6g}, {:.6g}]", quantity_text(range.median, unit), range.least, range.most);
}

GateResult judge(const registry::RunMetric& metric, const MetricTolerance& tolerance,
                 const MedianRange& before, const MedianRange& after, const Gates& gates) {
  GateResult result = number_gate(metric, tolerance, before.median, after.median);
  if (std::abs(after.median - before.median) <= *result.tolerance || !are_apart(before, after)) return result;
  judge_change(result, gates);
  result.message =
      fmt::format("{} -> {}, medians and ranges of replicates, which are further apart than either is wide",
                  range_text(before, metric.unit), range_text(after, metric.unit));
  return result;
}

/// More than half of the replicates have to agree that runs are no longer ok.
GateResult ok_gate(const RunSide& base, const RunSide& fresh, std::size_t base_ok, std::size_t fresh_ok) {
  const std::size_t base_all = base.all().size();
  const std::size_t fresh_all = fresh.all().size();
  GateResult result{"replicates", GateVerdict::unchanged, false, {}};
  if (base_ok * fresh_all == fresh_ok * base_all) return result;
  const bool worse = 2 * base_ok > base_all && 2 * fresh_ok <= fresh_all;
  result.verdict = worse ? GateVerdict::regression : GateVerdict::note;
  result.fails = worse;
  result.message = fmt::format("{}/{} replicates ok -> {}/{}", base_ok, base_all, fresh_ok, fresh_all);
  return result;
}

/// Ranges of few runs are apart by chance: they are shown and do not fail.
void do_not_gate(const RunPair& pair, const Gates& gates, std::vector<GateResult>& results) {
  const std::size_t fewest = std::min(pair.base.replicate_count(), pair.fresh.replicate_count());
  for (GateResult& result : results) {
    if (!result.base || result.verdict == GateVerdict::unchanged) continue;
    result.verdict = GateVerdict::note;
    result.fails = false;
    result.not_gated = fmt::format("{} run{} of a program that is not deterministic; {} are needed", fewest,
                                   fewest == 1 ? "" : "s", gates.min_repetitions);
    result.message += ", not gated: " + result.not_gated;
  }
}

}  // namespace

bool has_replicates_to_gate(const RunPair& pair, const Gates& gates) {
  return std::min(pair.base.replicate_count(), pair.fresh.replicate_count()) >= gates.min_repetitions;
}

std::vector<GateResult> replicate_gates(const RunPair& pair, const Gates& gates) {
  const std::vector<registry::RunNumbers> base = numbers_of(pair.base);
  const std::vector<registry::RunNumbers> fresh = numbers_of(pair.fresh);
  std::vector<GateResult> results = {ok_gate(pair.base, pair.fresh, base.size(), fresh.size())};
  for (std::size_t i = 0; i < gated_metrics().size(); ++i) {
    const registry::RunMetric& metric = *gated_metrics()[i];
    const auto before = registry::median_range(base, metric);
    const auto after = registry::median_range(fresh, metric);
    const auto tolerance = gates.tolerance(i, pair.experiment.recording, pair.experiment.variant);
    if (before && after) {
      results.push_back(judge(metric, tolerance, *before, *after, gates));
    } else if (before && !fresh.empty()) {
      GateResult gone = number_gate(metric, tolerance, before->median, std::nullopt);
      gone.verdict = GateVerdict::regression;
      gone.fails = true;
      gone.message = fmt::format("{} -> none in any replicate", range_text(*before, metric.unit));
      results.push_back(std::move(gone));
    }
  }
  if (!has_replicates_to_gate(pair, gates)) do_not_gate(pair, gates, results);
  return results;
}

}  // namespace fusebench::compare
