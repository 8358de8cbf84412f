// A picture of an evaluation, as evo_ape and evo_rpe draw it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/types.hpp"
#include "eval/report/evo_results/evo_result.hpp"
#include "eval/report/metric_reports/plot_parts.hpp"

namespace fusebench::metric_reports {

/// What errors are drawn over. Seconds and distances count from the first pose; without stamps, index.
enum class PlotAbscissa { index, seconds, distances };

struct ErrorPlot {
  const evo_results::EvoResult& result;
  const Trajectory& reference;  ///< drawn behind the errors
  const Trajectory& estimate;   ///< as compared
  std::vector<std::size_t> at;  ///< pose of each error; empty if the protocol has none
  PlotMode mode;
  PlotAbscissa abscissa = PlotAbscissa::seconds;
  std::optional<double> colour_min;             ///< error of the first colour; default: the least
  std::optional<double> colour_max;             ///< error of the last one; default: the largest
  std::optional<double> colour_max_percentile;  ///< of the errors, in place of colour_max
};

/// Errors over time with their statistics, and the estimate coloured by them over the reference.
[[nodiscard]] std::string plot_script(const ErrorPlot& plot, const PlotFile& file);

}  // namespace fusebench::metric_reports
