#include "eval/compare/findings/ranking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/config/variants.hpp"
#include "eval/record/record.hpp"
#include "eval/record/run_files/run_set.hpp"

namespace fusebench::findings {

namespace {

/// A recording, or a window of it: its name, first frame, and frames.
using Recording = std::tuple<std::string, std::size_t, std::size_t>;

/// The sum over runs that are ok, and their number.
using Sums = std::map<Recording, std::pair<double, std::size_t>>;

struct Candidate {
  RankedConfiguration configuration;
  Sums sums;
  std::map<Recording, std::vector<double>> values;  ///< of its runs: repetitions and replicates
};

double mean_of(const Sums& sums, const Recording& recording) {
  const auto& [sum, count] = sums.at(recording);
  return sum / static_cast<double>(count);
}

std::string description_of(const record::RunRecord& record) {
  if (record.program) {
    return record.program->version.empty()
               ? "a program from outside"
               : fmt::format("a program from outside, {}", record.program->version);
  }
  const auto variant = config::find_variant(record.variant);
  if (variant) return std::string(variant->sentence);  // also of a run that failed before it had options
  return "imported: it ran elsewhere, and was evaluated here";
}

/// What alone can be compared.
struct Comparable {
  std::string data;
  bool synthetic_imu = false;
  std::string frames;  ///< of Ranking
  bool operator==(const Comparable&) const = default;
};

/// Windows that share frames are no independent samples of their recording, so that their numbers are not
/// averaged; those that share none are.
std::set<std::string> recordings_with_shared_frames(const run_files::RunSet& rows) {
  std::map<std::string, std::set<std::pair<std::size_t, std::size_t>>> windows;  // first, end
  for (const run_files::RunIdentity& run : rows.runs()) {
    if (run.frames > 0) windows[run.recording].emplace(run.first_frame, run.first_frame + run.frames);
  }
  std::set<std::string> sharing;
  for (const auto& [recording, of_recording] : windows) {
    std::size_t end = 0;
    for (const auto& window : of_recording) {
      if (window.first < end) sharing.insert(recording);
      end = std::max(end, window.second);
    }
  }
  return sharing;
}

/// A run whose record is damaged failed among those of its recording.
std::string data_of(const tables::TableRow& row, const tables::ResultTable& table) {
  if (row.data != record::kUnknownWord) return row.data;
  const auto known = std::ranges::find_if(table.rows, [&](const tables::TableRow& other) {
    return other.recording == row.recording && other.data != record::kUnknownWord;
  });
  return known == table.rows.end() ? row.data : known->data;
}

std::vector<Comparable> comparables_of(const run_files::RunSet& rows, const tables::ResultTable& table) {
  const std::set<std::string> sharing = recordings_with_shared_frames(rows);
  const std::vector<std::string> imus = rows.imus();
  std::vector<Comparable> comparables;
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    comparables.push_back({data_of(table.rows[i], table), imus[i] == "synthetic IMU",
                           sharing.contains(table.rows[i].recording) ? table.rows[i].window : std::string()});
  return comparables;
}

/// Which frames of their recordings the rows are of: "frames 0:100"; empty: all.
std::string frames_of(const tables::ResultTable& table, const std::vector<std::size_t>& members) {
  std::set<std::string> windows;
  for (const std::size_t i : members) windows.insert(table.rows[i].window);
  return windows.size() == 1 ? *windows.begin() : "with parts of recordings";
}

/// What the runs are ranked by; null if none of them has such a number.
const registry::RunMetric* metric_for(const tables::ResultTable& table,
                                      const std::vector<std::size_t>& members) {
  for (const std::string_view key : {"ate_rmse_m", "aie_common_grey", "aie_grey"}) {
    const registry::RunMetric& metric = registry::run_metric(key);
    const bool any = std::ranges::any_of(members, [&](std::size_t member) {
      const tables::TableRow& row = table.rows[member];
      return row.status == record::RunStatus::ok && row.numbers[metric].value_or(0) > 0;
    });
    if (any) return &metric;
  }
  return nullptr;
}

/// members: rows of the table. labels: of configurations, one a row.
std::vector<Candidate> candidates_of(std::span<const run_files::FoundRun> runs,
                                     const tables::ResultTable& table,
                                     const std::vector<std::size_t>& members,
                                     const std::vector<std::string>& labels,
                                     const registry::RunMetric& metric) {
  std::vector<Candidate> candidates;
  for (const std::size_t i : members) {
    const tables::TableRow& row = table.rows[i];
    const std::string& label = labels[i];
    auto at = std::ranges::find(candidates, label, [](const Candidate& c) { return c.configuration.label; });
    if (at == candidates.end()) {
      at = candidates.insert(at, Candidate{});
      at->configuration.label = label;
      at->configuration.variant = row.variant;
      at->configuration.description = description_of(runs[row.members.front()].record);
    }
    RankedConfiguration& configuration = at->configuration;
    configuration.rows.push_back(i);
    configuration.runs += row.members.size();
    configuration.ok += row.ok_members;
    if (row.status != record::RunStatus::ok) continue;
    const auto value = row.numbers[metric];
    if (!value || !(*value > 0)) continue;
    configuration.tracked += row.tracked;
    configuration.frames += row.total;
    configuration.contradicts_truth |= row.contradicts_truth;
    const Recording recording(row.recording, row.first_frame, row.frames);
    auto& [sum, count] = at->sums[recording];
    sum += *value;
    ++count;
    std::vector<double>& values = at->values[recording];
    const std::size_t before = values.size();
    for (const registry::RunNumbers& replicate : row.replicates) {
      if (const auto number = replicate[metric]; number && *number > 0) values.push_back(*number);
    }
    if (values.size() == before) values.push_back(*value);
  }
  return candidates;
}

/// The mean ratios of all, from the same resamples.
void add_means(std::vector<Candidate>& candidates, const std::set<Recording>& recordings) {
  aggregate::ReplicatedValues values;
  for (const Recording& recording : recordings) {
    auto& of_recording = values.emplace_back();
    for (Candidate& candidate : candidates) {
      std::ranges::sort(candidate.values[recording]);
      of_recording.push_back(candidate.values[recording]);
    }
  }
  const std::vector<aggregate::RatioMean> means = aggregate::ratio_means(values);
  for (std::size_t i = 0; i < means.size(); ++i) candidates[i].configuration.mean = means[i];
}

void rank(std::vector<Candidate>& candidates, const std::set<Recording>& recordings) {
  add_means(candidates, recordings);
  for (Candidate& candidate : candidates) {
    candidate.configuration.recordings = candidate.sums.size();
    if (candidate.sums.size() < recordings.size() || recordings.empty()) continue;
    double sum = 0;
    for (const Recording& recording : recordings) sum += std::log(mean_of(candidate.sums, recording));
    candidate.configuration.value = std::exp(sum / static_cast<double>(recordings.size()));
  }
  std::ranges::stable_sort(candidates, {}, [](const Candidate& candidate) {
    const RankedConfiguration& k = candidate.configuration;
    return std::tuple(-static_cast<double>(k.recordings), !k.mean.tied, k.mean.ratio.value_or(0));
  });
}

}  // namespace

std::vector<Ranking> rankings_of(std::span<const run_files::FoundRun> runs,
                                 const tables::ResultTable& table) {
  const run_files::RunSet rows(std::vector<run_files::RunIdentity>(table.rows.begin(), table.rows.end()));
  const std::vector<std::string> labels = rows.configuration_labels();
  const std::vector<Comparable> comparables = comparables_of(rows, table);
  std::vector<Ranking> rankings;
  for (std::size_t first = 0; first < comparables.size(); ++first) {
    const auto same = std::ranges::find(comparables, comparables[first]);
    if (same != comparables.begin() + static_cast<std::ptrdiff_t>(first)) continue;  // had its turn
    std::vector<std::size_t> members;
    for (std::size_t i = first; i < comparables.size(); ++i) {
      if (comparables[i] == comparables[first]) members.push_back(i);
    }
    const registry::RunMetric* const metric = metric_for(table, members);
    if (metric == nullptr) continue;
    std::vector<Candidate> candidates = candidates_of(runs, table, members, labels, *metric);
    // An AIE of other pixels than another's says which dropped more of them, not which is better.
    if (metric->key == "aie_grey" && candidates.size() > 1) continue;
    std::set<Recording> recordings;
    for (const Candidate& candidate : candidates) {
      for (const auto& [recording, sum] : candidate.sums) recordings.insert(recording);
    }
    rank(candidates, recordings);
    Ranking ranking{comparables[first].data,   comparables[first].synthetic_imu,
                    frames_of(table, members), metric,
                    recordings.size(),         {}};
    for (Candidate& candidate : candidates)
      ranking.configurations.push_back(std::move(candidate.configuration));
    rankings.push_back(std::move(ranking));
  }
  return rankings;
}

}  // namespace fusebench::findings
