// Quantiles of lists of numbers.
#pragma once

#include <utility>
#include <vector>

namespace fusebench::inspection::measures {

/// The value below which `fraction` of the values lie (0 to 1, nearest rank); 0 for an empty list.
[[nodiscard]] double quantile(std::vector<double> values, double fraction);
[[nodiscard]] inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace fusebench::inspection::measures
