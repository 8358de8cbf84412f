// The paper's Table 1 and the results of its readings.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.hpp"
#include "eval/compare/reproduction/table1_plan.hpp"
#include "eval/metrics/intensity_readings.hpp"
#include "eval/page/page.hpp"
#include "eval/suites/engine/job_outcome.hpp"

namespace fusebench::reproduction {

/// One method on one recording.
struct MethodNumbers {
  std::optional<metrics::IntensityReadings> grey;  ///< nothing if the run failed
  double lost_share = 1;                           ///< frames that were not tracked
  std::string failure;                             ///< why there is no number
};

/// Both methods of a reading on one recording.
struct RecordingNumbers {
  std::size_t reading = 0;
  std::string group;
  std::string recording;
  std::string data;  ///< "recorded, synthetic IMU", "simulated"
  MethodNumbers dm;
  MethodNumbers ours;
};

/// A mean over recordings of AIE of the direct method over that of deformed patches, with what it rests on.
struct Ratio {
  std::size_t recordings = 0;  ///< of which both methods have a number
  std::size_t failed = 0;
  double dm_grey = std::numeric_limits<double>::quiet_NaN();  ///< mean over recordings
  double ours_grey = std::numeric_limits<double>::quiet_NaN();
  double ratio = std::numeric_limits<double>::quiet_NaN();  ///< geometric mean of the recordings' ratios
  /// 95 % interval of it (Student's t on the logarithms); absent of fewer than two recordings.
  std::optional<std::array<double, 2>> interval;
  double dm_lost_share = 0;
  double ours_lost_share = 0;
};
/// Of those of one group and reading.
[[nodiscard]] Ratio ratio_of(const std::vector<RecordingNumbers>& numbers, std::size_t reading,
                             const std::string& group, const metrics::IntensityReading& aie = {});

/// A column of the result: recordings that stand for a row of the paper.
struct ResultColumn {
  Column column;
  std::string speed;  ///< "slow" or "fast", as the paper groups its rows
  double published_dm = 0;
  double published_ours = 0;
  [[nodiscard]] double published_ratio() const { return published_dm / published_ours; }
};

/// Whether a reading has the paper's pattern: nearly equal when slow, about twice when fast.
struct Pattern {
  double slow = std::numeric_limits<double>::quiet_NaN();  ///< geometric mean of the columns' ratios
  double fast = std::numeric_limits<double>::quiet_NaN();
  bool lost = false;  ///< a method lost more than a tenth of the frames of a column
  [[nodiscard]] bool is_papers() const;
};

struct Table1 {
  Table1Protocol protocol;
  std::vector<ResultColumn> columns;  ///< those with runs, in the protocol's order
  std::vector<std::size_t> readings;  ///< those with runs
  std::vector<RecordingNumbers> numbers;
  std::vector<std::string> absent;

  [[nodiscard]] Pattern pattern_of(std::size_t reading) const;
  /// The paper's own, over the same rows.
  [[nodiscard]] Pattern published_pattern() const;
};

/// Reads the records of the runs. Errors: io, data_corrupt.
[[nodiscard]] Result<Table1> table1_of(const Table1Protocol& protocol, const Table1Plan& plan,
                                       const std::vector<engine::BatchOutcome>& outcomes);

/// The same as a page; readings with the paper's pattern are marked.
[[nodiscard]] page::Page table1_page(const Table1& table);

/// "markdown", "latex" or "json".
[[nodiscard]] std::string render_table1(const Table1& table, const std::string& format);

}  // namespace fusebench::reproduction
