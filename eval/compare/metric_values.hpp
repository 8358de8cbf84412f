// The numbers of a run that are gated: those of the registry of metrics that have a tolerance.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "eval/record/registry/run_metric.hpp"

namespace fusebench::compare {

/// Numbers that the same binary, recording and configuration give again, to the last bit.
[[nodiscard]] std::span<const registry::RunMetric* const> gated_metrics();

/// Times and sizes, which differ between repetitions; smaller is better in all of them.
[[nodiscard]] std::span<const registry::RunMetric* const> gated_costs();

/// "0.0123 m"; six digits, and no unit for shares.
[[nodiscard]] std::string quantity_text(double value, std::string_view unit);

}  // namespace fusebench::compare
