#include "eval/study/bar_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "eval/metrics/consistency_metrics.hpp"
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

double comparison(const suites::Bar& bar, double own, double other) {
  if (bar.against.empty()) return own;
  return bar.compare == suites::BarComparison::ratio ? own / other : own - other;
}

bool is_meant(const suites::Bar& bar, const StudyRun& run, std::string_view half) {
  const bool in_group =
      bar.groups.empty() || std::find(bar.groups.begin(), bar.groups.end(), run.group) != bar.groups.end();
  return in_group && run.half == half && run.variant == bar.variant;
}

void take(const Study& study, const suites::Bar& bar, const StudyRun& run, Items& items) {
  const suites::StudyValue& value = *suites::find_study_value(bar.metric);
  if (run.record.status != record::RunStatus::ok && !value.of_every_run) {
    if (bar.lost_counts && run.record.status == record::RunStatus::lost) {
      ++items.counted_as_lost;
    } else {
      items.not_ok.push_back(run.recording);
    }
    return;
  }
  Item item{&run};
  if (!bar.against.empty()) {
    const StudyRun* other = sibling(study, run, bar.against);
    if (other == nullptr) return;  // the suite does not run that variant here
    if (other->record.status != record::RunStatus::ok && !value.of_every_run) {
      items.left_out.push_back(run.recording);
      return;
    }
    const auto number = value_of(study, *other, value, bar.variant);
    if (!number) {
      (other->record.status == record::RunStatus::ok ? items.valueless : items.left_out)
          .push_back(run.recording);
      return;
    }
    item.other = *number;
  }
  const auto number = value_of(study, run, value, bar.against);
  if (!number) {
    (run.record.status == record::RunStatus::ok ? items.valueless : items.not_ok).push_back(run.recording);
    return;
  }
  item.own = *number;
  item.compared = comparison(bar, item.own, item.other);
  items.items.push_back(item);
}

/// All frames of all recordings together.
std::optional<double> pooled(const Study& study, const suites::Bar& bar, const Items& items) {
  const bool reversed = bar.variant == study.reference();
  std::vector<SharedFrame> frames;
  for (const Item& item : items.items) {
    const StudyRun& run = reversed ? *sibling(study, *item.run, bar.against) : *item.run;
    for (const SharedFrame& frame : run.shared) {
      if (bar.frames_above_px && !(frame.motion_px && *frame.motion_px > *bar.frames_above_px)) continue;
      frames.push_back(frame);
    }
  }
  if (frames.empty()) return std::nullopt;
  const SharedMeans means = shared_means(frames);
  return reversed ? comparison(bar, means.reference_grey, means.variant_grey)
                  : comparison(bar, means.variant_grey, means.reference_grey);
}

std::vector<double> numbers(const Items& items, double Item::*which) {
  std::vector<double> result;
  for (const Item& item : items.items) result.push_back(item.*which);
  return result;
}

double share(const suites::Bar& bar, const Items& items) {
  const auto keeps = [&](const Item& item) {
    return (!bar.each_at_most || item.compared <= *bar.each_at_most) &&
           (!bar.each_at_least || item.compared >= *bar.each_at_least);
  };
  const auto met = std::count_if(items.items.begin(), items.items.end(), keeps);
  return (static_cast<double>(met) + static_cast<double>(items.counted_as_lost)) /
         static_cast<double>(items.items.size() + items.counted_as_lost);
}

const Item& worst(const suites::Bar& bar, const Items& items) {
  const auto smaller = [](const Item& a, const Item& b) { return a.compared < b.compared; };
  return bar.has_upper() ? *std::max_element(items.items.begin(), items.items.end(), smaller)
                         : *std::min_element(items.items.begin(), items.items.end(), smaller);
}

std::optional<double> measured(const Study& study, const suites::Bar& bar, const Items& items) {
  if (bar.statistic == suites::BarStatistic::share) return share(bar, items);
  if (items.items.empty()) return std::nullopt;
  if (bar.statistic == suites::BarStatistic::worst) return worst(bar, items).compared;
  if (bar.of_means) {
    if (suites::find_study_value(bar.metric)->of == nullptr) return pooled(study, bar, items);
    return comparison(bar, metrics::statistics(numbers(items, &Item::own)).mean,
                      metrics::statistics(numbers(items, &Item::other)).mean);
  }
  const metrics::Statistics stats = metrics::statistics(numbers(items, &Item::compared));
  return bar.statistic == suites::BarStatistic::mean ? stats.mean : stats.median;
}

struct Limit {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool strict = false;
  std::string text;

  [[nodiscard]] bool allows(double value) const {
    return strict ? value > lower && value < upper : value >= lower && value <= upper;
  }
};

Limit limit_of(const suites::Bar& bar, std::size_t runs) {
  Limit limit;
  if (bar.within_bounds) {
    if (runs == 0) return limit;
    const metrics::NeesBounds bounds =
        metrics::nees_bounds_95(runs, suites::find_study_value(bar.metric)->nees_dof);
    limit.lower = bounds.lower;
    limit.upper = bounds.upper;
    limit.text = fmt::format("{:.3g} .. {:.3g} (95 % of {} runs)", bounds.lower, bounds.upper, runs);
    return limit;
  }
  limit.strict = bar.below || bar.above;
  if (bar.has_lower()) limit.lower = bar.at_least ? *bar.at_least : *bar.above;
  if (bar.has_upper()) limit.upper = bar.at_most ? *bar.at_most : *bar.below;
  const std::string_view equal = limit.strict ? "" : "=";
  limit.text = bar.has_lower() && bar.has_upper() ? fmt::format("{:g} .. {:g}", limit.lower, limit.upper)
               : bar.has_upper()                  ? fmt::format("<{} {:g}", equal, limit.upper)
                                                  : fmt::format(">{} {:g}", equal, limit.lower);
  return limit;
}

std::string note_of(const suites::Bar& bar, const Items& items) {
  std::vector<std::string> parts;
  if (bar.statistic == suites::BarStatistic::worst && items.items.size() > 1)
    parts.push_back(fmt::format("worst: {}", worst(bar, items).run->recording));
  if (items.counted_as_lost > 0) parts.push_back(fmt::format("{} lost", items.counted_as_lost));
  if (!items.not_ok.empty()) parts.push_back(fmt::format("not ok: {}", fmt::join(items.not_ok, ", ")));
  if (!items.valueless.empty())
    parts.push_back(fmt::format("without the number: {}", fmt::join(items.valueless, ", ")));
  if (!items.left_out.empty())
    parts.push_back(fmt::format("left out, {} is not ok: {}", bar.against, fmt::join(items.left_out, ", ")));
  return fmt::format("{}", fmt::join(parts, "; "));
}

BarMeasurement measure(const Study& study, const suites::Bar& bar, std::string_view half) {
  Items items;
  for (const StudyRun& run : study.runs) {
    if (is_meant(bar, run, half)) take(study, bar, run, items);
  }
  BarMeasurement result;
  result.half = half;
  result.recordings = items.items.size() + items.counted_as_lost;
  const Limit limit = limit_of(bar, result.recordings);
  result.limit = limit.text;
  result.note = note_of(bar, items);
  if (result.recordings > 0) result.measured = measured(study, bar, items);
  if (!items.not_ok.empty() || (result.recordings > 0 && !items.valueless.empty())) {
    result.verdict = Verdict::failed;
  } else if (result.measured) {
    result.verdict = limit.allows(*result.measured) ? Verdict::passed : Verdict::failed;
  }
  return result;
}

}  // namespace

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::passed:
      return "PASS";
    case Verdict::failed:
      return "FAIL";
    case Verdict::not_applicable:
      break;
  }
  return "n.a.";
}

std::vector<BarResult> check_bars(const Study& study, std::span<const suites::Bar> bars) {
  std::vector<BarResult> results;
  for (const suites::Bar& bar : bars) {
    const std::string_view beside =
        bar.half == suites::kHeldOutHalf ? suites::kTuningHalf : suites::kHeldOutHalf;
    results.push_back({bar, measure(study, bar, bar.half), measure(study, bar, beside)});
  }
  return results;
}

}  // namespace fusebench::study
