#include "eval/compare/reproduction/table1.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "eval/compare/aggregate/mean_ratio.hpp"
#include "eval/compare/tables/published_table.hpp"
#include "eval/record/data_labels.hpp"
#include "eval/record/record.hpp"

namespace fusebench::reproduction {

namespace {

Result<MethodNumbers> numbers_of(const engine::BatchOutcome& outcome, std::string& data) {
  MethodNumbers numbers;
  numbers.failure = outcome.reason;
  if (outcome.folder.empty()) return numbers;
  const auto record = record::read_record(outcome.folder / "record.json");
  if (!record) return tl::unexpected(record.error());
  numbers.grey = record->metrics.intensity_readings.value;
  if (!numbers.grey && numbers.failure.empty()) numbers.failure = record->metrics.intensity_readings.reason;
  const auto total = static_cast<double>(record->frames.total);
  if (total > 0) numbers.lost_share = 1.0 - static_cast<double>(record->frames.tracked) / total;
  const record::DataWords words = record::words_of(record->recording);
  data = record::data_cell(words);
  if (words.imu == "synthetic IMU") data += ", synthetic IMU";
  return numbers;
}

void describe_mean(const std::vector<double>& logarithms, Ratio& ratio) {
  const aggregate::MeanRatio mean = aggregate::mean_ratio(logarithms);
  ratio.ratio = mean.ratio;
  ratio.interval = mean.interval;
}

double geometric_mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const double value : values) sum += std::log(value);
  return std::exp(sum / static_cast<double>(values.size()));
}

Result<std::vector<ResultColumn>> columns_of(const Table1Protocol& protocol,
                                             const std::vector<RecordingNumbers>& numbers) {
  const auto published = tables::published_table("table1");
  if (!published) return tl::unexpected(published.error());
  std::vector<ResultColumn> columns;
  for (const Column& column : protocol.columns) {
    if (std::ranges::find(numbers, column.group, &RecordingNumbers::group) == numbers.end()) continue;
    const auto row = std::ranges::find(published->rows, column.row, &tables::PublishedRow::label);
    check(row != published->rows.end() && row->published.size() == 2,
          "each column of the reproduction must name a row of the published table");
    columns.push_back(
        {column, row->group, row->published.front().value_or(0), row->published.back().value_or(0)});
  }
  return columns;
}

}  // namespace

Ratio ratio_of(const std::vector<RecordingNumbers>& numbers, std::size_t reading, const std::string& group,
               const metrics::IntensityReading& aie) {
  Ratio ratio;
  std::vector<double> logarithms;
  double dm_sum = 0, ours_sum = 0;
  for (const RecordingNumbers& recording : numbers) {
    if (recording.reading != reading || recording.group != group) continue;
    const double dm = recording.dm.grey ? recording.dm.grey->of(aie) : std::nan("");
    const double ours = recording.ours.grey ? recording.ours.grey->of(aie) : std::nan("");
    if (!(dm > 0) || !(ours > 0)) {
      ++ratio.failed;
      continue;
    }
    ++ratio.recordings;
    dm_sum += dm;
    ours_sum += ours;
    ratio.dm_lost_share += recording.dm.lost_share;
    ratio.ours_lost_share += recording.ours.lost_share;
    logarithms.push_back(std::log(dm / ours));
  }
  if (logarithms.empty()) return ratio;
  const auto count = static_cast<double>(ratio.recordings);
  ratio.dm_grey = dm_sum / count;
  ratio.ours_grey = ours_sum / count;
  ratio.dm_lost_share /= count;
  ratio.ours_lost_share /= count;
  describe_mean(logarithms, ratio);
  return ratio;
}

bool Pattern::is_papers() const {
  // The paper's slow rows are 1.03 to 1.40 (geometric mean 1.20), its fast ones 1.75 and 2.20 (1.96).
  constexpr double kMostSlow = 1.5, kLeastFast = 1.5, kLeastApart = 1.2;
  return !lost && slow <= kMostSlow && fast >= kLeastFast && fast >= kLeastApart * slow;
}

Pattern Table1::pattern_of(std::size_t reading) const {
  constexpr double kMostLost = 0.1;
  std::vector<double> slow, fast;
  Pattern pattern;
  for (const ResultColumn& column : columns) {
    const Ratio ratio = ratio_of(numbers, reading, column.column.group);
    if (ratio.recordings == 0) continue;
    (column.speed == "fast" ? fast : slow).push_back(ratio.ratio);
    pattern.lost |= std::max(ratio.dm_lost_share, ratio.ours_lost_share) > kMostLost || ratio.failed > 0;
  }
  pattern.slow = geometric_mean(slow);
  pattern.fast = geometric_mean(fast);
  return pattern;
}

Pattern Table1::published_pattern() const {
  std::vector<double> slow, fast;
  std::vector<std::string> rows;
  for (const ResultColumn& column : columns) {
    if (std::ranges::find(rows, column.column.row) != rows.end()) continue;
    rows.push_back(column.column.row);
    (column.speed == "fast" ? fast : slow).push_back(column.published_ratio());
  }
  return {geometric_mean(slow), geometric_mean(fast), false};
}

Result<Table1> table1_of(const Table1Protocol& protocol, const Table1Plan& plan,
                         const std::vector<engine::BatchOutcome>& outcomes) {
  Table1 table{protocol, {}, {}, {}, plan.absent};
  for (const ComparedRuns& runs : plan.compared) {
    RecordingNumbers numbers{runs.reading, runs.group, runs.recording, {}, {}, {}};
    auto dm = numbers_of(outcomes[runs.dm], numbers.data);
    if (!dm) return tl::unexpected(dm.error());
    auto ours = numbers_of(outcomes[runs.ours], numbers.data);
    if (!ours) return tl::unexpected(ours.error());
    numbers.dm = std::move(*dm);
    numbers.ours = std::move(*ours);
    table.numbers.push_back(std::move(numbers));
    if (std::ranges::find(table.readings, runs.reading) == table.readings.end())
      table.readings.push_back(runs.reading);
  }
  auto columns = columns_of(protocol, table.numbers);
  if (!columns) return tl::unexpected(columns.error());
  table.columns = std::move(*columns);
  return table;
}

}  // namespace fusebench::reproduction
