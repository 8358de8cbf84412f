#include "eval/compare/study/study_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/config/variants.hpp"
#include "eval/metrics/statistics.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/suites/suite_simulations.hpp"

namespace fusebench::study {

namespace {

/// Each text once, in the order in which they come.
std::vector<std::string> distinct(const Study& study, std::string StudyRun::*text) {
  std::vector<std::string> result;
  for (const StudyRun& run : study.runs) {
    if (std::find(result.begin(), result.end(), run.*text) == result.end()) result.push_back(run.*text);
  }
  return result;
}

std::vector<std::string> variants_in_order(const Study& study) {
  std::vector<std::string> present = distinct(study, &StudyRun::variant);
  std::vector<std::string> ordered;
  for (const config::Variant& variant : config::all_variants()) {
    if (std::find(present.begin(), present.end(), variant.name) != present.end())
      ordered.emplace_back(variant.name);
  }
  return ordered;
}

ValueSpread spread_of(const Study& study, const std::vector<const StudyRun*>& runs,
                      const registry::RunMetric& metric) {
  ValueSpread spread;
  std::vector<double> values;
  std::vector<double> partners;
  for (const StudyRun* run : runs) {
    const auto number = value_of(study, *run, metric);
    if (!number) continue;
    const bool worse = values.empty() || (metric.better == registry::Better::larger ? *number < spread.worst
                                                                                    : *number > spread.worst);
    if (worse) {
      spread.worst = *number;
      spread.worst_recording = run->recording;
    }
    values.push_back(*number);
    if (!metric.takes_several_runs()) continue;
    spread.partner = run->variant == study.reference() ? study.partner() : study.reference();
    const auto partner = value_of(study, *sibling(study, *run, spread.partner), metric, run->variant);
    if (partner) partners.push_back(*partner);
  }
  spread.count = values.size();
  if (values.empty()) return spread;
  const metrics::Statistics stats = metrics::statistics(values);
  spread.mean = stats.mean;
  spread.median = stats.median;
  if (!partners.empty()) spread.partner_mean = metrics::statistics(partners).mean;
  if (metric.nees_dof > 0) spread.bounds_95 = metrics::nees_bounds_95(values.size(), metric.nees_dof);
  return spread;
}

std::optional<SummaryRow> row_of(const Study& study, const std::string& split, const std::string& group,
                                 const std::string& variant) {
  SummaryRow row{.split = split, .group = group, .variant = variant, .values = {}};
  std::vector<const StudyRun*> runs;
  for (const StudyRun& run : study.runs) {
    if (run.split != split || run.group != group || run.variant != variant) continue;
    runs.push_back(&run);
    ++row.total;
    if (run.record.status == record::RunStatus::ok) ++row.ok;
    if (run.record.status == record::RunStatus::lost) ++row.lost;
    row.lost_frames += run.record.frames.lost;
    row.frames += run.record.frames.total;
  }
  if (runs.empty()) return std::nullopt;
  for (const registry::RunMetric* metric : registry::columns_of(registry::Column::study))
    row.values.push_back(spread_of(study, runs, *metric));
  return row;
}

/// Nothing if no frame of these has a motion.
std::optional<MotionCurve> curve_of(const Study& study, const std::string& split, std::string_view group) {
  MotionCurve curve{split, std::string(group), {}};
  bool any = false;
  for (std::size_t i = 0; i < kMotionEdges_px.size(); ++i) {
    MotionBin bin;
    bin.from_px = kMotionEdges_px[i];
    if (i + 1 < kMotionEdges_px.size()) bin.to_px = kMotionEdges_px[i + 1];
    std::vector<SharedFrame> frames;
    for (const StudyRun& run : study.runs) {
      if (run.split != split || run.variant != study.partner()) continue;
      if (group != kAllGroups && run.group != group) continue;
      for (const SharedFrame& frame : run.shared) {
        const bool inside =
            frame.motion_px && *frame.motion_px >= bin.from_px && *frame.motion_px < bin.to_px;
        if (inside) frames.push_back(frame);
      }
    }
    bin.means = shared_means(frames);
    any = any || bin.means.frames > 0;
    curve.bins.push_back(bin);
  }
  return any ? std::optional(std::move(curve)) : std::nullopt;
}

/// Footnotes of where the data come from, each with the groups that it is about.
std::vector<std::string> data_notes(const Study& study) {
  std::vector<std::string> notes;
  for (const record::DataLabel& label : record::data_labels()) {
    std::vector<std::string> groups;
    for (const StudyRun& run : study.runs) {
      const bool known = std::find(groups.begin(), groups.end(), run.group) != groups.end();
      if (!known && label.applies(record::words_of(run.record.recording))) groups.push_back(run.group);
    }
    if (!groups.empty()) notes.push_back(fmt::format("{} ({})", label.footnote(), fmt::join(groups, ", ")));
  }
  return notes;
}

}  // namespace

StudySummary summarise(const std::string& suite, const Study& study,
                       std::span<const suites::Criterion> criteria) {
  StudySummary summary;
  summary.suite = suite;
  summary.reference = study.reference();
  summary.partner = study.partner();
  summary.notes = data_notes(study);
  summary.notes.insert(summary.notes.end(), study.notes.begin(), study.notes.end());
  const std::vector<std::string> groups = distinct(study, &StudyRun::group);
  const std::vector<std::string> variants = variants_in_order(study);
  for (const std::string_view split_name : {suites::kHeldOutSplit, suites::kTuningSplit}) {
    const std::string split(split_name);
    for (const std::string& group : groups) {
      for (const std::string& variant : variants) {
        if (auto row = row_of(study, split, group, variant)) summary.rows.push_back(std::move(*row));
      }
    }
    if (auto curve = curve_of(study, split, kAllGroups)) summary.curves.push_back(std::move(*curve));
    for (const std::string& group : groups) {
      if (auto curve = curve_of(study, split, group)) summary.curves.push_back(std::move(*curve));
    }
  }
  summary.criteria = check_criteria(study, criteria);
  return summary;
}

}  // namespace fusebench::study
