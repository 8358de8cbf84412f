#include "eval/compare/aggregate/ratio_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <utility>

#include "eval/record/registry/replicated_numbers.hpp"

namespace fusebench::aggregate {

namespace {

constexpr std::size_t kResamples = 1000;
constexpr std::size_t kLeastWithNumbers = 20;  // resamples from which an interval is computed
constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

/// log[recording][configuration]: natural logarithm of the median; NaN where there is none.
using Logarithms = std::vector<std::vector<double>>;

double log_median(const std::vector<double>& values) {
  const auto range = registry::median_range(values);
  return range ? std::log(range->median) : kAbsent;
}

double drawn_log_median(const std::vector<double>& values, std::mt19937_64& random) {
  if (values.size() < 2) return log_median(values);
  std::vector<double> drawn;
  for (std::size_t i = 0; i < values.size(); ++i) drawn.push_back(values[random() % values.size()]);
  return log_median(drawn);
}

/// Subtracts the smallest of a recording.
void relate_to_best(std::vector<double>& logarithms) {
  double best = std::numeric_limits<double>::infinity();
  for (const double value : logarithms) {
    if (!std::isnan(value)) best = std::min(best, value);
  }
  for (double& value : logarithms) value -= best;
}

/// Of a configuration minus that of `other`, over the rows in which both have numbers; NaN without any.
double mean_difference(const Logarithms& rows, std::size_t configuration, std::optional<std::size_t> other) {
  double sum = 0;
  std::size_t count = 0;
  for (const std::vector<double>& row : rows) {
    const double difference = row[configuration] - (other ? row[*other] : 0.0);
    if (std::isnan(difference)) continue;
    sum += difference;
    ++count;
  }
  return count == 0 ? kAbsent : sum / static_cast<double>(count);
}

/// The percentiles 2.5 and 97.5 (nearest ranks).
std::optional<std::array<double, 2>> interval_of(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.size() < kLeastWithNumbers) return std::nullopt;
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return std::array<double, 2>{at(0.025), at(0.975)};
}

/// The rows of a resample: as many recordings as there are, each with resampled runs.
Logarithms resampled(const ReplicatedValues& values, std::mt19937_64& random) {
  Logarithms rows;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double>& row = rows.emplace_back();
    for (const std::vector<double>& runs : values[random() % values.size()])
      row.push_back(drawn_log_median(runs, random));
    relate_to_best(row);
  }
  return rows;
}

/// Whether a resample can differ from the values.
bool varies(const ReplicatedValues& values, std::size_t configuration) {
  std::size_t recordings = 0;
  bool replicates = false;
  for (const auto& row : values) {
    recordings += row[configuration].empty() ? 0U : 1U;
    replicates = replicates || row[configuration].size() > 1;
  }
  return recordings > 1 || replicates;
}

std::size_t leader_of(const std::vector<RatioMean>& means) {
  const auto key = [](const RatioMean& mean) {
    return std::pair(-static_cast<double>(mean.recordings), mean.ratio.value_or(0));
  };
  return static_cast<std::size_t>(std::ranges::min_element(means, {}, key) - means.begin());
}

bool all_positive(const ReplicatedValues& values) {
  for (const auto& row : values) {
    for (const auto& runs : row) {
      if (std::ranges::any_of(runs, [](double value) { return !(value > 0) || std::isinf(value); }))
        return false;
    }
  }
  return true;
}

/// Intervals and ties, from the same resamples for all configurations.
void add_intervals(const ReplicatedValues& values, std::vector<RatioMean>& means) {
  const std::size_t leader = leader_of(means);
  std::mt19937_64 random(1);
  std::vector<std::vector<double>> ratios(means.size());
  std::vector<std::vector<double>> differences(means.size());
  for (std::size_t k = 0; k < kResamples; ++k) {
    const Logarithms rows = resampled(values, random);
    for (std::size_t c = 0; c < means.size(); ++c) {
      ratios[c].push_back(mean_difference(rows, c, std::nullopt));
      differences[c].push_back(mean_difference(rows, c, leader));
    }
  }
  for (std::size_t c = 0; c < means.size(); ++c) {
    RatioMean& mean = means[c];
    if (!mean.ratio) continue;
    mean.tied =
        c == leader || (mean.recordings == means[leader].recordings && *mean.ratio == *means[leader].ratio);
    if (!varies(values, c)) continue;
    if (const auto interval = interval_of(std::move(ratios[c])))
      mean.interval = {std::exp((*interval)[0]), std::exp((*interval)[1])};
    const auto difference = interval_of(std::move(differences[c]));
    const bool separate = !difference || (*difference)[0] > 0 || (*difference)[1] < 0;
    mean.tied = mean.tied || (!separate && mean.recordings == means[leader].recordings);
  }
}

}  // namespace

std::vector<RatioMean> ratio_means(const ReplicatedValues& values) {
  std::vector<RatioMean> means(values.empty() ? 0 : values.front().size());
  if (means.empty() || !all_positive(values)) return means;
  Logarithms rows;
  for (const auto& row : values) {
    std::vector<double>& logarithms = rows.emplace_back();
    for (const std::vector<double>& runs : row) logarithms.push_back(log_median(runs));
    relate_to_best(logarithms);
  }
  for (std::size_t c = 0; c < means.size(); ++c) {
    means[c].recordings = static_cast<std::size_t>(
        std::ranges::count_if(values, [&](const auto& row) { return !row[c].empty(); }));
    if (means[c].recordings > 0) means[c].ratio = std::exp(mean_difference(rows, c, std::nullopt));
  }
  add_intervals(values, means);
  return means;
}

}  // namespace fusebench::aggregate
