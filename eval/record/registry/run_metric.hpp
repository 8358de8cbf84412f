// The registry of metrics: one row for each number of a run that tables, gates, criteria and reports use.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/error.hpp"
#include "eval/record/record.hpp"

namespace fusebench::registry {

class RunNumbers;

/// Which change of a number is an improvement.
enum class Better {
  smaller,
  larger,
  neither,  ///< every change fails its gate
};
[[nodiscard]] std::string_view to_string(Better better);  ///< "smaller", "larger", "equal"

enum class MetricKind {
  estimate,  ///< depends on inputs alone; a real number
  count,     ///< depends on inputs alone; of frames or of parts of the model
  cost,      ///< time or memory: differs between repetitions
};

/// Tables in which a metric is a column.
enum class Column {
  none = 0,
  runs = 1,     ///< a row per run (`table`)
  systems = 2,  ///< a row per recording and system (`table --systems`)
  study = 4,    ///< a row per group and variant of a suite with criteria
};
[[nodiscard]] constexpr Column operator|(Column a, Column b) {
  return static_cast<Column>(static_cast<int>(a) | static_cast<int>(b));
}

/// One row. A number comes from the record (`path` and `of`), from other numbers of the same run (`from`), or
/// from several runs (neither, such as AIE on common pixels).
struct RunMetric {
  std::string_view key = {};      ///< in CSV, JSON, gates and criteria; ends with the unit
  std::string_view word = {};     ///< short name on the command line; empty: the key alone
  std::string_view unit = {};     ///< of the number: "m", "rad", "grey", "frames"; "1" for shares and ratios
  std::string_view heading = {};  ///< of a column, with the unit that is shown: "ATE [cm]"
  double shown_factor = 1;        ///< shown number / number
  int decimals = 2;               ///< shown
  Better better = Better::smaller;
  MetricKind kind = MetricKind::estimate;
  Column columns = Column::none;
  /// Means are over all runs; otherwise over those that are ok.
  bool of_every_run = false;
  /// Degrees of freedom of a normalised estimation error squared; 0 of other metrics.
  int nees_dof = 0;
  /// A relative change up to this does not fail `compare`; of costs: more than the ratio of medians - 1.
  /// Absent: `compare` has no gate for it.
  std::optional<double> tolerance = 1e-9;
  std::string_view definition = {};  ///< one sentence, without a full stop
  std::string_view path = {};        ///< in record.json: keys and indices of arrays, separated by points
  /// The same number of a record in memory, finite, or why there is none.
  record::Outcome<double> (*of)(const record::RunRecord& record) = nullptr;
  std::optional<double> (*from)(const RunNumbers& numbers) = nullptr;

  [[nodiscard]] constexpr bool is_column_of(Column table) const {
    return (static_cast<int>(columns) & static_cast<int>(table)) != 0;
  }
  [[nodiscard]] constexpr bool takes_several_runs() const { return of == nullptr && from == nullptr; }
};

/// All rows, in the order in which they are listed; costs are last. Valid for ever.
[[nodiscard]] std::span<const RunMetric> run_metrics();

/// The one metric that a study computes on pairs of runs.
inline constexpr std::string_view kCommonPixelsKey = "aie_common_grey";

/// The row of a key that exists.
[[nodiscard]] const RunMetric& run_metric(std::string_view key);
/// Null if there is none of that key.
[[nodiscard]] const RunMetric* find_metric(std::string_view key);
/// Position in run_metrics().
[[nodiscard]] std::size_t index_of(const RunMetric& metric);

/// By word or key, of those of which a smaller number is better. Error usage, with the allowed words.
[[nodiscard]] Result<const RunMetric*> find_ranking_metric(std::string_view name);

/// Those that are columns of a table, in their order.
[[nodiscard]] std::span<const RunMetric* const> columns_of(Column table);

/// A number of the metric as tables show it: factor and decimals of the row, without its unit.
[[nodiscard]] std::string shown_text(const RunMetric& metric, double value);

}  // namespace fusebench::registry
