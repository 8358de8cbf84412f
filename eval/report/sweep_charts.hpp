// Charts of a parameter sweep.
#pragma once

#include <vector>

#include "eval/compare/aggregate/effects.hpp"
#include "eval/compare/aggregate/pareto.hpp"
#include "eval/page/page.hpp"

namespace fusebench::report {

/// Of each option the metric's ratio at its values, and beside it the share of runs that were lost or failed,
/// where there are any.
[[nodiscard]] std::vector<page::Chart> effect_charts(const aggregate::SweepEffects& effects);

/// Of each pair of options a curve for each value of one of them (at most eight) over the values of the
/// other; parallel curves do not interact. None of a pair that always changes together.
[[nodiscard]] std::vector<page::Chart> interaction_charts(const aggregate::SweepEffects& effects);

/// All configurations as dots, the front as a line, in the units that people see.
[[nodiscard]] page::Chart pareto_chart(const aggregate::ParetoFront& front);

}  // namespace fusebench::report
