#include "eval/findings/ranking.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/config/variants.hpp"
#include "eval/record/record.hpp"
#include "eval/run_files/run_labels.hpp"

namespace fusebench::findings {

namespace {

/// A recording, or a window of it.
using Recording = std::pair<std::string, std::size_t>;

/// The sum over runs that are ok, and their number.
using Sums = std::map<Recording, std::pair<double, std::size_t>>;

struct Candidate {
  RankedConfiguration configuration;
  Sums sums;
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

std::optional<tables::TableColumn> column_for(const tables::ResultTable& table, const std::string& data) {
  for (const auto value : {&tables::TableValues::ate_rmse_m, &tables::TableValues::aie_common_grey}) {
    const auto column = std::ranges::find(tables::table_columns(), value, &tables::TableColumn::value);
    const bool any = std::ranges::any_of(table.rows, [&](const tables::TableRow& row) {
      return row.data == data && row.status == record::RunStatus::ok && row.*value && *(row.*value) > 0;
    });
    if (any) return *column;
  }
  return std::nullopt;
}

std::vector<Candidate> candidates_of(std::span<const run_files::FoundRun> runs,
                                     const tables::ResultTable& table, const std::string& data,
                                     const tables::TableColumn& column) {
  const std::vector<std::string> edits = run_files::differing_edits(run_files::traits_of(runs));
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const tables::TableRow& row = table.rows[i];
    if (row.data != data) continue;
    const std::string label = row.variant + (edits[i].empty() ? "" : " ") + edits[i];
    auto at = std::ranges::find(candidates, label, [](const Candidate& c) { return c.configuration.label; });
    if (at == candidates.end()) {
      at = candidates.insert(at, Candidate{});
      at->configuration.label = label;
      at->configuration.variant = row.variant;
      at->configuration.description = description_of(runs[i].record);
    }
    RankedConfiguration& configuration = at->configuration;
    ++configuration.runs;
    configuration.imu_from_truth |= row.imu == "synthetic IMU";
    if (row.status != record::RunStatus::ok) continue;
    ++configuration.ok;
    const auto value = row.*column.value;
    if (!value || !(*value > 0)) continue;
    auto& [sum, count] = at->sums[{row.recording, row.first_frame}];
    sum += *value;
    ++count;
  }
  return candidates;
}

/// Over the recordings that both have; nothing if there are none.
std::optional<aggregate::MeanRatio> ratio_of(const Candidate& candidate, const Candidate& best) {
  std::vector<double> logarithms;
  for (const auto& [recording, sums] : candidate.sums) {
    if (best.sums.contains(recording))
      logarithms.push_back(std::log(mean_of(candidate.sums, recording) / mean_of(best.sums, recording)));
  }
  if (logarithms.empty()) return std::nullopt;
  return aggregate::mean_ratio(logarithms);
}

void rank(std::vector<Candidate>& candidates, const std::set<Recording>& recordings) {
  for (Candidate& candidate : candidates) {
    candidate.configuration.recordings = candidate.sums.size();
    if (candidate.sums.size() < recordings.size() || recordings.empty()) continue;
    std::vector<double> logarithms;
    for (const Recording& recording : recordings)
      logarithms.push_back(std::log(mean_of(candidate.sums, recording)));
    candidate.configuration.value = aggregate::mean_ratio(logarithms).ratio;
  }
  const auto by_value = [](const Candidate& c) {
    const RankedConfiguration& k = c.configuration;
    return std::tuple(!k.value.has_value(), k.value ? *k.value : -static_cast<double>(k.recordings));
  };
  std::ranges::stable_sort(candidates, {}, by_value);
  const Candidate& best = candidates.front();
  for (Candidate& candidate : std::span(candidates).subspan(1))
    candidate.configuration.to_best = ratio_of(candidate, best);
  const auto by_ratio = [](const Candidate& c) {
    const RankedConfiguration& k = c.configuration;
    return std::tuple(!k.value.has_value(), !k.to_best, k.to_best ? k.to_best->ratio : 0.0);
  };
  std::ranges::stable_sort(candidates.begin() + 1, candidates.end(), {}, by_ratio);
}

}  // namespace

std::vector<Ranking> rankings_of(std::span<const run_files::FoundRun> runs,
                                 const tables::ResultTable& table) {
  std::vector<std::string> kinds;
  for (const tables::TableRow& row : table.rows) {
    if (std::ranges::find(kinds, row.data) == kinds.end()) kinds.push_back(row.data);
  }
  std::vector<Ranking> rankings;
  for (const std::string& data : kinds) {
    const auto column = column_for(table, data);
    if (!column) continue;
    std::vector<Candidate> candidates = candidates_of(runs, table, data, *column);
    std::set<Recording> recordings;
    for (const Candidate& candidate : candidates) {
      for (const auto& [recording, sum] : candidate.sums) recordings.insert(recording);
    }
    rank(candidates, recordings);
    Ranking ranking{data, *column, recordings.size(), {}};
    for (Candidate& candidate : candidates)
      ranking.configurations.push_back(std::move(candidate.configuration));
    rankings.push_back(std::move(ranking));
  }
  return rankings;
}

}  // namespace fusebench::findings
