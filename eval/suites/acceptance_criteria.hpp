// Acceptance criteria of a suite: each is one number of its runs, and a limit.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "eval/suites/suite_entries.hpp"

namespace fusebench::suites {

/// How the values of several recordings become one.
enum class CriterionStatistic {
  worst,   ///< the largest under an upper limit, the smallest over a lower one
  mean,    ///< over recordings
  median,  ///< over recordings
  share,   ///< of recordings whose value keeps each_at_most and each_at_least
};
enum class CriterionComparison { ratio, difference };  ///< variant / against, variant - against

/// One acceptance criterion.
///
///     [[criteria]]
///     title = "full is within 1 cm on slow motion"   # required
///     groups = ["slow"]                 # default: all groups
///     split = "held-out"                # default; the other split is measured, too, but decides nothing
///     variant = "full"                  # required; a list makes a criterion for each
///     metric = "ate_rmse_m"             # required, see registry::run_metrics(); a list makes a criterion
///     for each statistic = "worst"               # required: worst, mean, median, share at_most = 0.01 # or
///     below; at_least, above; upper and lower limits may go together against = "dm"                    #
///     compares with another variant; a list makes a criterion for each compare = "ratio"                 #
///     default: variant / against; or "difference": variant - against of_means = true                   #
///     compares the two means instead of averaging comparisons frames_above_px = 30              # only
///     frames in which patches moved further than that, all recordings'
///                                       # frames together; for aie_common_grey with of_means
///     each_at_least = 5                 # or each_at_most: for statistic = "share"
///     lost_counts = true                # a run that is lost counts into the share
///     within_bounds = true              # for nees_*: the 95 % bounds of the mean over so many runs
struct Criterion {
  std::string title;
  std::vector<std::string> groups;  ///< empty: all
  std::string split;
  std::string variant;
  std::string metric;
  CriterionStatistic statistic = CriterionStatistic::worst;
  std::optional<double> at_most;
  std::optional<double> at_least;
  std::optional<double> below;
  std::optional<double> above;
  std::string against;  ///< empty: the value itself
  CriterionComparison compare = CriterionComparison::ratio;
  bool of_means = false;
  std::optional<double> frames_above_px;
  std::optional<double> each_at_most;
  std::optional<double> each_at_least;
  bool lost_counts = false;
  bool within_bounds = false;
  std::string place;

  [[nodiscard]] bool has_upper() const { return at_most || below; }
  [[nodiscard]] bool has_lower() const { return at_least || above; }
};

/// In the order of the file; a table with lists gives several. Errors: configuration, with file:line.
/// reference: the variant that the suite names first, which AIE on common pixels is measured against.
[[nodiscard]] Result<std::vector<Criterion>> read_criteria(const std::vector<EntryTable>& tables,
                                                           std::string_view reference);

}  // namespace fusebench::suites
