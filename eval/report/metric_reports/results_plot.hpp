// A picture of several results, as evo_res draws it.
#pragma once

#include <string>
#include <vector>

#include "eval/report/evo_results/result_table.hpp"
#include "eval/report/metric_reports/plot_parts.hpp"

namespace fusebench::metric_reports {

/// Errors of the results over time, and their statistics side by side. At least one.
[[nodiscard]] std::string plot_script(const std::vector<evo_results::LabelledResult>& results,
                                      const PlotFile& file);

}  // namespace fusebench::metric_reports
