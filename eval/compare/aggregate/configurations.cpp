#include "eval/compare/aggregate/configurations.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

#include "eval/record/data_labels.hpp"
#include "eval/record/run_files/found_runs.hpp"
#include "eval/record/run_files/option_order.hpp"

namespace fusebench::aggregate {

namespace {

struct ConfigurationKey {
  std::size_t rank = 0;
  std::string variant;
  RunOptions options;
  std::string imu;

  bool operator<(const ConfigurationKey& other) const {
    if (variant != other.variant) return std::tie(rank, variant) < std::tie(other.rank, other.variant);
    if (options != other.options) return run_files::RunOptionsLess()(options, other.options);
    return imu < other.imu;
  }
};

struct RecordingTally {
  std::size_t runs = 0;
  std::size_t ok = 0;
  std::map<std::size_t, std::vector<double>> values;  ///< of ok runs, by replicate

  [[nodiscard]] std::vector<double> all_values() const {
    std::vector<double> all;
    for (const auto& [replicate, of_replicate] : values)
      all.insert(all.end(), of_replicate.begin(), of_replicate.end());
    return all;
  }
};

using Tallies = std::map<std::string, RecordingTally>;  // by part of a recording

/// The range, over the replicates that all recordings have, of the mean over recordings.
registry::MedianRange spread_of(double mean, const std::vector<const RecordingTally*>& tallies) {
  std::vector<double> means;
  for (const auto& [replicate, ignored] : tallies.front()->values) {
    std::vector<double> values;
    for (const RecordingTally* tally : tallies) {
      const auto found = tally->values.find(replicate);
      if (found != tally->values.end()) values.push_back(registry::median_range(found->second)->median);
    }
    if (values.size() == tallies.size()) means.push_back(ordered_mean(std::move(values)));
  }
  if (means.size() < 2) return {mean, mean, mean};
  return *registry::median_range(std::move(means));
}

ConfigurationSummary summary_of(const ConfigurationKey& key, const Tallies& tallies,
                                const std::vector<std::string>& recordings) {
  ConfigurationSummary summary;
  summary.variant = key.variant;
  summary.options = key.options;
  summary.imu = key.imu;
  std::vector<double> medians;
  std::vector<const RecordingTally*> measured;
  for (const std::string& recording : recordings) {
    const auto found = tallies.find(recording);
    if (found == tallies.end()) {
      summary.not_run.push_back(recording);
      continue;
    }
    const RecordingTally& tally = found->second;
    summary.n_total += tally.runs;
    const std::vector<double> values = tally.all_values();
    summary.n_ok += values.size();
    if (tally.ok < tally.runs) summary.failed.push_back(recording);
    if (values.size() < tally.ok) summary.without_number.push_back(recording);
    if (values.empty()) continue;
    medians.push_back(registry::median_range(values)->median);
    measured.push_back(&tally);
  }
  if (medians.empty()) return summary;
  summary.mean = ordered_mean(std::move(medians));
  summary.spread = spread_of(*summary.mean, measured);
  return summary;
}

}  // namespace

double ordered_mean(std::vector<double> values) {
  check(!values.empty(), "a mean is of something");
  std::ranges::sort(values);
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

ConfigurationSummaries summarise_configurations(std::span<const RunRow* const> runs,
                                                const registry::RunMetric& metric) {
  struct Recording {
    bool any_ok = false;
    bool any_value = false;
  };
  std::map<std::string, std::size_t> ranks;
  std::map<ConfigurationKey, Tallies> tallies;
  std::map<std::string, Recording> recordings;
  for (const RunRow* run : runs) {
    if (!run->attributable()) continue;
    const auto [rank, is_new] = ranks.try_emplace(run->variant, 0);
    if (is_new) rank->second = run_files::variant_rank(run->variant);
    const std::string part = run->recorded_part();
    RecordingTally& tally = tallies[{rank->second, run->variant, run->options, run->imu}][part];
    Recording& recording = recordings[part];
    ++tally.runs;
    if (run->status != record::RunStatus::ok) continue;
    recording.any_ok = true;
    ++tally.ok;
    const std::optional<double> value = run->numbers[metric];
    if (!value) continue;
    recording.any_value = true;
    tally.values[run->replicate].push_back(*value);
  }
  ConfigurationSummaries summaries;
  for (const auto& [name, recording] : recordings) {
    const bool measured = recording.any_value || !recording.any_ok;
    (measured ? summaries.recordings : summaries.without_number).push_back(name);
  }
  if (summaries.recordings.empty()) return summaries;
  ReplicatedValues values(summaries.recordings.size());
  for (const auto& [key, of_key] : tallies) {
    ConfigurationSummary summary = summary_of(key, of_key, summaries.recordings);
    if (summary.n_total == 0) continue;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto found = of_key.find(summaries.recordings[i]);
      std::vector<double> of_recording =
          found == of_key.end() ? std::vector<double>() : found->second.all_values();
      std::ranges::sort(of_recording);  // resamples draw by place, and the order of runs must not count
      values[i].push_back(std::move(of_recording));
    }
    summaries.configurations.push_back(std::move(summary));
  }
  const std::vector<RatioMean> ratios = ratio_means(values);
  for (std::size_t c = 0; c < ratios.size(); ++c) summaries.configurations[c].ratio = ratios[c];
  return summaries;
}

std::map<std::string, std::string> recording_kinds(std::span<const RunRow> rows, KindsBy by) {
  // A run that failed early knows nothing of its recording, so that any other one's word counts.
  struct Words {
    bool simulated = false;
    bool pseudo_truth = false;
    bool synthetic_imu = false;
  };
  std::map<std::string, Words> words;
  for (const RunRow& row : rows) {
    Words& recording = words[row.recording];
    recording.simulated |= row.data == "simulated";
    recording.pseudo_truth |= row.truth == record::kPseudoTruthWord;
    recording.synthetic_imu |= row.imu == "synthetic IMU";
  }
  std::map<std::string, std::string> kinds;
  for (const auto& [name, recording] : words) {
    std::string& kind = kinds[name];
    kind = record::data_cell({recording.simulated ? "simulated" : "recorded", "",
                              recording.pseudo_truth ? record::kPseudoTruthWord : std::string_view()});
    if (recording.synthetic_imu && by == KindsBy::data_and_imu) kind += ", IMUs synthetic";
  }
  return kinds;
}

}  // namespace fusebench::aggregate
