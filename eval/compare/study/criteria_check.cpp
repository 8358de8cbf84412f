#include "eval/compare/study/criteria_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "eval/metrics/nees_metrics.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::study {

namespace {

/// What one recording says.
struct Item {
  const StudyRun* run = nullptr;
  double own = 0;
  double other = 0;
  double compared = 0;  // what the statistic is taken of
};

struct Items {
  std::vector<Item> items;
  std::size_t counted_as_lost = 0;     // into the share
  std::vector<std::string> not_ok;     // recordings
  std::vector<std::string> valueless;  // ok, but without the number
  std::vector<std::string> left_out;   // nothing to compare with
};

double comparison(const suites::Criterion& criterion, double own, double other) {
  if (criterion.against.empty()) return own;
  return criterion.compare == suites::CriterionComparison::ratio ? own / other : own - other;
}

bool is_meant(const suites::Criterion& criterion, const StudyRun& run, std::string_view split) {
  const bool in_group =
      criterion.groups.empty() ||
      std::find(criterion.groups.begin(), criterion.groups.end(), run.group) != criterion.groups.end();
  return in_group && run.split == split && run.variant == criterion.variant;
}

void take(const Study& study, const suites::Criterion& criterion, const StudyRun& run, Items& items) {
  const registry::RunMetric& value = registry::run_metric(criterion.metric);
  if (run.record.status != record::RunStatus::ok && !value.of_every_run) {
    if (criterion.lost_counts && run.record.status == record::RunStatus::lost) {
      ++items.counted_as_lost;
    } else {
      items.not_ok.push_back(run.recording);
    }
    return;
  }
  Item item{&run};
  if (!criterion.against.empty()) {
    const StudyRun* other = sibling(study, run, criterion.against);
    if (other == nullptr) return;  // the suite does not run that variant here
    if (other->record.status != record::RunStatus::ok && !value.of_every_run) {
      items.left_out.push_back(run.recording);
      return;
    }
    const auto number = value_of(study, *other, value, criterion.variant);
    if (!number) {
      (other->record.status == record::RunStatus::ok ? items.valueless : items.left_out)
          .push_back(run.recording);
      return;
    }
    item.other = *number;
  }
  const auto number = value_of(study, run, value, criterion.against);
  if (!number) {
    (run.record.status == record::RunStatus::ok ? items.valueless : items.not_ok).push_back(run.recording);
    return;
  }
  item.own = *number;
  item.compared = comparison(criterion, item.own, item.other);
  items.items.push_back(item);
}

/// All frames of all recordings together.
std::optional<double> pooled(const Study& study, const suites::Criterion& criterion, const Items& items) {
  const bool reversed = criterion.variant == study.reference();
  std::vector<SharedFrame> frames;
  for (const Item& item : items.items) {
    const StudyRun& run = reversed ? *sibling(study, *item.run, criterion.against) : *item.run;
    for (const SharedFrame& frame : run.shared) {
      if (criterion.frames_above_px && !(frame.motion_px && *frame.motion_px > *criterion.frames_above_px))
        continue;
      frames.push_back(frame);
    }
  }
  if (frames.empty()) return std::nullopt;
  const SharedMeans means = shared_means(frames);
  return reversed ? comparison(criterion, means.reference_grey, means.variant_grey)
                  : comparison(criterion, means.variant_grey, means.reference_grey);
}

std::vector<double> numbers(const Items& items, double Item::*which) {
  std::vector<double> result;
  for (const Item& item : items.items) result.push_back(item.*which);
  return result;
}

double share(const suites::Criterion& criterion, const Items& items) {
  const auto keeps = [&](const Item& item) {
    return (!criterion.each_at_most || item.compared <= *criterion.each_at_most) &&
           (!criterion.each_at_least || item.compared >= *criterion.each_at_least);
  };
  const auto met = std::count_if(items.items.begin(), items.items.end(), keeps);
  return (static_cast<double>(met) + static_cast<double>(items.counted_as_lost)) /
         static_cast<double>(items.items.size() + items.counted_as_lost);
}

const Item& worst(const suites::Criterion& criterion, const Items& items) {
  const auto smaller = [](const Item& a, const Item& b) { return a.compared < b.compared; };
  return criterion.has_upper() ? *std::max_element(items.items.begin(), items.items.end(), smaller)
                               : *std::min_element(items.items.begin(), items.items.end(), smaller);
}

std::optional<double> measured(const Study& study, const suites::Criterion& criterion, const Items& items) {
  if (criterion.statistic == suites::CriterionStatistic::share) return share(criterion, items);
  if (items.items.empty()) return std::nullopt;
  if (criterion.statistic == suites::CriterionStatistic::worst) return worst(criterion, items).compared;
  if (criterion.of_means) {
    if (registry::run_metric(criterion.metric).takes_several_runs()) return pooled(study, criterion, items);
    return comparison(criterion, metrics::statistics(numbers(items, &Item::own)).mean,
                      metrics::statistics(numbers(items, &Item::other)).mean);
  }
  const metrics::Statistics stats = metrics::statistics(numbers(items, &Item::compared));
  return criterion.statistic == suites::CriterionStatistic::mean ? stats.mean : stats.median;
}

/// The jackknife's standard error of a mean; nothing for other statistics (it is not one of a median, nor of
/// the worst) and for too few recordings.
std::optional<double> noise_of(const Study& study, const suites::Criterion& criterion, const Items& items) {
  constexpr std::size_t kFewest = 3;
  const std::size_t count = items.items.size();
  if (criterion.statistic != suites::CriterionStatistic::mean || count < kFewest) return std::nullopt;
  std::vector<double> without;
  for (std::size_t i = 0; i < count; ++i) {
    Items others;
    others.items = items.items;
    others.items.erase(others.items.begin() + static_cast<std::ptrdiff_t>(i));
    const auto value = measured(study, criterion, others);
    if (!value) return std::nullopt;
    without.push_back(*value);
  }
  const metrics::Statistics stats = metrics::statistics(without);
  return std::sqrt(static_cast<double>(count - 1)) * stats.std;
}

struct Limit {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool strict = false;
  std::string text;

  [[nodiscard]] bool allows(double value) const {
    return strict ? value > lower && value < upper : value >= lower && value <= upper;
  }
  /// Of an allowed value.
  [[nodiscard]] double margin(double value) const { return std::min(upper - value, value - lower); }
};

Limit limit_of(const suites::Criterion& criterion, std::size_t runs) {
  Limit limit;
  if (criterion.within_bounds) {
    if (runs == 0) return limit;
    const metrics::NeesBounds bounds =
        metrics::nees_bounds_95(runs, registry::run_metric(criterion.metric).nees_dof);
    limit.lower = bounds.lower;
    limit.upper = bounds.upper;
    limit.text = fmt::format("{:.3g} .. {:.3g} (95 % of {} runs)", bounds.lower, bounds.upper, runs);
    return limit;
  }
  limit.strict = criterion.below || criterion.above;
  if (criterion.has_lower()) limit.lower = criterion.at_least ? *criterion.at_least : *criterion.above;
  if (criterion.has_upper()) limit.upper = criterion.at_most ? *criterion.at_most : *criterion.below;
  const std::string_view equal = limit.strict ? "" : "=";
  limit.text = criterion.has_lower() && criterion.has_upper()
                   ? fmt::format("{:g} .. {:g}", limit.lower, limit.upper)
               : criterion.has_upper() ? fmt::format("<{} {:g}", equal, limit.upper)
                                       : fmt::format(">{} {:g}", equal, limit.lower);
  return limit;
}

std::string note_of(const suites::Criterion& criterion, const Items& items) {
  std::vector<std::string> parts;
  if (criterion.statistic == suites::CriterionStatistic::worst && items.items.size() > 1)
    parts.push_back(fmt::format("worst: {}", worst(criterion, items).run->recording));
  if (items.counted_as_lost > 0) parts.push_back(fmt::format("{} lost", items.counted_as_lost));
  if (!items.not_ok.empty()) parts.push_back(fmt::format("not ok: {}", fmt::join(items.not_ok, ", ")));
  if (!items.valueless.empty())
    parts.push_back(fmt::format("without the number: {}", fmt::join(items.valueless, ", ")));
  if (!items.left_out.empty())
    parts.push_back(
        fmt::format("left out, {} is not ok: {}", criterion.against, fmt::join(items.left_out, ", ")));
  return fmt::format("{}", fmt::join(parts, "; "));
}

CriterionMeasurement measure(const Study& study, const suites::Criterion& criterion, std::string_view split) {
  Items items;
  for (const StudyRun& run : study.runs) {
    if (is_meant(criterion, run, split)) take(study, criterion, run, items);
  }
  CriterionMeasurement result;
  result.split = split;
  result.recordings = items.items.size() + items.counted_as_lost;
  const Limit limit = limit_of(criterion, result.recordings);
  result.limit = limit.text;
  result.note = note_of(criterion, items);
  if (result.recordings > 0) result.measured = measured(study, criterion, items);
  if (!items.not_ok.empty() || (result.recordings > 0 && !items.valueless.empty())) {
    result.verdict = Verdict::failed;
  } else if (result.measured) {
    result.noise = noise_of(study, criterion, items);
    result.verdict = limit.allows(*result.measured) ? Verdict::passed : Verdict::failed;
    if (result.verdict == Verdict::passed && result.noise && limit.margin(*result.measured) < *result.noise)
      result.verdict = Verdict::tied;
  }
  return result;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed:
      return "PASS";
    case Verdict::tied:
      return "TIE";
    case Verdict::failed:
      return "FAIL";
    case Verdict::not_applicable:
      break;
  }
  return "n.a.";
}

std::vector<CriterionResult> check_criteria(const Study& study, std::span<const suites::Criterion> criteria) {
  std::vector<CriterionResult> results;
  for (const suites::Criterion& criterion : criteria) {
    const std::string_view beside =
        criterion.split == suites::kHeldOutSplit ? suites::kTuningSplit : suites::kHeldOutSplit;
    results.push_back(
        {criterion, measure(study, criterion, criterion.split), measure(study, criterion, beside)});
  }
  return results;
}

}  // namespace fusebench::study
